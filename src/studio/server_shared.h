// For the sources of the server alone: Boost.Beast takes long to compile.
#pragma once

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/websocket/error.hpp>
#include <fmt/format.h>

#include "studio/answer_lanes.h"
#include "studio/connection.h"
#include "studio/server.h"

namespace hvas::studio {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using beast::error_code;
using tcp = asio::ip::tcp;

/** State that all sessions of the server share. For one thread. */
struct ServerShared {
  ServerShared(Workbench* bench, std::vector<Example> examples, const ServerOptions& given)
      : workbench(bench),
        audit(std::make_unique<AuditLog>(given.audit_file)),
        hub(bench, std::move(examples), audit.get()),
        options(given) {
    hub.SetStudyDesk(given.desk);
  }

  Workbench* workbench;
  std::unique_ptr<AuditLog> audit;
  Hub hub;
  ServerOptions options;
  std::unique_ptr<Access> access;
  std::unique_ptr<asio::ssl::context> tls;  ///< Null: plain HTTP.
  std::shared_ptr<ConnectionTable> connections{std::make_shared<ConnectionTable>()};
  AnswerLanes* lanes{nullptr};  ///< Outlives all sessions.

  /** Saves the access control after a change, in the background: once for all changes that come
   before the disk is free. */
  void SaveAccessState() {
    if (is_access_to_save.exchange(true)) {
      return;
    }
    lanes->Post(AnswerLanes::Lane::kDisk, [this](const std::stop_token& /*stop*/) {
      is_access_to_save = false;
      SaveAccessNow(access->Keep());
    });
  }

  /** Prints a warning the first time that this fails. For the disk lane, and while there is none.
   */
  void SaveAccessNow(const SavedAccess& kept) {
    if (options.access_file.empty()) {
      return;
    }
    const auto saved = SaveAccess(options.access_file, kept);
    if (!saved && std::exchange(can_save_access, false)) {
      fmt::print(stderr,
                 "warning: the links cannot be saved, so the next start makes new ones: {}\n",
                 saved.error().ToString());
    }
  }

  /** Gives the study desk an unused participant's link, which the experimenter passes on. */
  void UpdateParticipantLink() {
    if (options.desk != nullptr) {
      options.desk->SetParticipantLink("/#t=" + access->FindUnusedLink(Role::kParticipant));
    }
  }

  bool can_save_access{true};
  std::atomic<bool> is_access_to_save{false};  ///< A job of the disk lane is going to save it.
};

}  // namespace hvas::studio
