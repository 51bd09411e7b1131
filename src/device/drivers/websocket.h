#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"

namespace hvas::device {

/** One end of a WebSocket (RFC 6455) for text messages. Belongs to one thread; allocates. */
class WebSocket {
 public:
  /** Connects to ws://host:port/ within a time. Errors: kNotFound (nobody listens, no such host, no
   answer), kUnreadable (it answers, but speaks no WebSocket). */
  static Result<std::unique_ptr<WebSocket>> Connect(const std::string& host, std::uint16_t port,
                                                    int timeout_ms);

  WebSocket() = default;
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;
  virtual ~WebSocket() = default;

  /** Queues a message, and sends what can be sent without waiting. */
  virtual void Send(std::string text) = 0;

  /** The oldest message that came and was not taken yet; waits for one for at most this time. */
  virtual std::optional<std::string> Receive(std::int64_t timeout_ns) = 0;

  [[nodiscard]] virtual bool is_open() const = 0;
};

/** Listens for WebSockets on the loopback interface, for calls that do not wait. */
class WebSocketServer {
 public:
  /** Port 0: any. Error: kOutOfResource. */
  static Result<std::unique_ptr<WebSocketServer>> Listen(std::uint16_t port);

  WebSocketServer() = default;
  WebSocketServer(const WebSocketServer&) = delete;
  WebSocketServer& operator=(const WebSocketServer&) = delete;
  virtual ~WebSocketServer() = default;

  [[nodiscard]] virtual std::uint16_t port() const = 0;

  /** Does all that can be done without waiting. Whoever has just connected is sent what `greet`
   returns, and each message is answered by what `answer` returns, if anything. */
  virtual void Serve(
      const std::function<std::string()>& greet,
      const std::function<std::optional<std::string>(const std::string&)>& answer) = 0;

  /** Hangs up on everybody. */
  virtual void Drop() = 0;
};

}  // namespace hvas::device
