#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "studio/access.h"
#include "studio/hub.h"
#include "studio/workbench.h"

namespace hvas::studio {

struct ServerOptions {
  std::uint16_t port{0};                 ///< 0: any that is free.
  std::filesystem::path upload_folder;   ///< Exists, and is this process's own.
  std::vector<std::string> names;        ///< Hosts besides the loopback's that it answers to.
  std::uint64_t most_upload{256 << 20};  ///< [bytes]
};

/** The studio's HTTP and WebSocket server (docs/protocol.md) on the loopback interface, with one
 thread of its own. */
class Server {
 public:
  Server(Workbench* workbench, std::vector<Example> examples, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /** Binds and begins to answer. Errors (kOutOfResource): the port is taken. */
  [[nodiscard]] Result<void> Start();

  /** Lets everybody go. @pre the workbench has stopped: it tells nobody any more. */
  void Stop();

  [[nodiscard]] std::uint16_t port() const;

  /** The address to open, with the token of a role in its fragment, which no server ever sees. */
  [[nodiscard]] std::string LinkFor(Role role) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hvas::studio
