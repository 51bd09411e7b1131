#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "studio/access.h"
#include "studio/certificate.h"
#include "studio/hub.h"
#include "studio/workbench.h"

namespace hvas::studio {

struct ServerOptions {
  std::string address{"127.0.0.1"};      ///< To listen on; another than the loopback's needs `tls`.
  std::uint16_t port{0};                 ///< 0: any that is free.
  std::optional<TlsFiles> tls;           ///< None: it speaks http.
  std::filesystem::path upload_folder;   ///< Exists, and is this process's own.
  std::filesystem::path access_file;     ///< Keeps KeptAccess; empty: nothing is kept of it.
  std::vector<std::string> reachable;    ///< Addresses that it could listen on for others.
  std::vector<std::string> names;        ///< Hosts besides the loopback's that it answers to.
  std::uint64_t most_upload{256 << 20};  ///< [bytes]
  /** With whoever is connected and says nothing: a handshake, a header, an answer that is not read,
   a WebSocket that does not answer. */
  std::chrono::milliseconds patience{30'000};
  StudyDesk* desk{nullptr};  ///< Of the study that is run; null: none.
};

/** The studio's HTTP and WebSocket server (docs/protocol.md), with one thread of its own. */
class Server {
 public:
  Server(Workbench* workbench, std::vector<Example> examples, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /** Binds and begins to answer, at the port that was kept where none is asked for. Errors:
   kOutOfResource when the port is taken or the address is another machine's, kInvalid for an
   address that is none or would be spoken with unencrypted, kUnreadable for a certificate or a key
   that cannot be used. */
  [[nodiscard]] Result<void> Start();

  /** Lets everybody go. @pre the workbench has stopped: it tells nobody any more. */
  void Stop();

  [[nodiscard]] std::uint16_t port() const;

  /** The links of the start before are good again. */
  [[nodiscard]] bool has_kept_links() const;

  /** The address to open, with the token of a role in its fragment, which no server ever sees. */
  [[nodiscard]] std::string LinkFor(Role role, std::string_view host = "127.0.0.1") const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::studio
