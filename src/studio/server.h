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
  std::string address{"127.0.0.1"};  ///< Address to listen on; beyond the loopback it needs `tls`.
  std::uint16_t port{0};             ///< Port to listen on; 0: any free one.
  std::optional<TlsFiles> tls;       ///< None: plain HTTP.
  std::filesystem::path upload_folder;  ///< Exists; no other process uses it.
  std::filesystem::path access_file;    ///< File of SavedAccess; empty: it is not saved.
  std::filesystem::path audit_file;     ///< File of AuditLog; empty: nothing is noted.
  std::vector<std::string> reachable;   ///< Addresses for links of other machines.
  std::vector<std::string> names;       ///< Host names that it answers to besides the loopback's.
  std::uint64_t max_upload{256 << 20};  ///< Largest upload [bytes].
  /** Time after which an inactive connection is closed: an unfinished handshake or header, a
   response that is not read, a WebSocket that does not answer pings. */
  std::chrono::milliseconds patience{30'000};
  StudyDesk* desk{nullptr};  ///< Session of a study; null: none is run.
};

/** The studio's HTTP and WebSocket server (docs/protocol.md), with one thread of its own. */
class Server {
 public:
  Server(Workbench* workbench, std::vector<Example> examples, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /** Binds and listens; at the port of the previous start when port 0 is asked for. Errors:
   kOutOfResource when the port is in use or the address is another machine's; kInvalid for a
   malformed address, or one beyond the loopback without TLS; kUnreadable for a certificate or key
   that cannot be used. */
  [[nodiscard]] Result<void> Start();

  /** Closes all connections. @pre the workbench has stopped, and sends no more events. */
  void Stop();

  [[nodiscard]] std::uint16_t port() const;

  /** Whether the links of the previous start are valid. */
  [[nodiscard]] bool has_kept_links() const;

  /** URL to open, with the token of a role in its fragment, which browsers do not send to
   servers. */
  [[nodiscard]] std::string LinkFor(Role role, std::string_view host = "127.0.0.1") const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::studio
