#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::device {

/** An IPv4 address and port, as the network has them (big-endian). */
struct Endpoint {
  std::uint32_t host{0};
  std::uint16_t port{0};

  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

/** Reads numbers, as "127.0.0.1", or "localhost". Error: kInvalid. */
[[nodiscard]] Result<Endpoint> ParseEndpoint(const std::string& host, std::uint16_t port);

/** A UDP socket that never waits. */
class DatagramSocket {
 public:
  /** Errors: kInvalid (no such address here), kOutOfResource (port in use). Port 0: any. */
  static Result<DatagramSocket> Bind(const std::string& host, std::uint16_t port);

  [[nodiscard]] std::uint16_t port() const;

  /** The next datagram, cut to the buffer; none when nothing is there. RT-safe. */
  [[nodiscard]] std::optional<std::span<const std::byte>> Receive(std::span<std::byte> buffer,
                                                                  Endpoint* sender) noexcept;
  /** Lost when the system has no room for it. RT-safe. */
  void Send(std::span<const std::byte> bytes, const Endpoint& receiver) noexcept;

  /** Waits for a datagram. Not RT-safe. */
  void WaitFor(int timeout_ms) const;

 private:
  explicit DatagramSocket(Descriptor socket) : socket_(std::move(socket)) {}

  Descriptor socket_;
};

}  // namespace hvas::device
