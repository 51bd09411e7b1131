#include "device/drivers/datagram_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <system_error>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>

namespace hvas::device {
namespace {

sockaddr_in ToSystem(const Endpoint& endpoint) noexcept {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = endpoint.host;
  address.sin_port = endpoint.port;
  return address;
}

}  // namespace

Result<Endpoint> ParseEndpoint(const std::string& host, std::uint16_t port) {
  in_addr address{};
  if (::inet_pton(AF_INET, host == "localhost" ? "127.0.0.1" : host.c_str(), &address) != 1) {
    return Fail(
        ErrorCode::kInvalid, fmt::format("\"{}\" is not an IPv4 address", host), {},
        "give a numeric address such as 127.0.0.1, or 0.0.0.0 for all networks of this machine");
  }
  return Endpoint{address.s_addr, htons(port)};
}

Result<DatagramSocket> DatagramSocket::Bind(const std::string& host, std::uint16_t port) {
  const auto endpoint = ParseEndpoint(host, port);
  if (!endpoint) {
    return Unexpected(endpoint.error());
  }
  DatagramSocket socket(
      Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)));
  const sockaddr_in address = ToSystem(*endpoint);
  if (::bind(socket.socket_.value(), reinterpret_cast<const sockaddr*>(&address),
             sizeof(address)) != 0) {
    const int reason = errno;
    const std::string where = fmt::format("UDP {}:{}", host, port);
    if (reason == EADDRINUSE) {
      return Fail(ErrorCode::kOutOfResource, "another program uses this port", where,
                  "end that program, or choose another port");
    }
    return Fail(ErrorCode::kInvalid,
                fmt::format("HVAS cannot listen on this address: {}",
                            std::generic_category().message(reason)),
                where, "give an address of this machine, and a port above 1023");
  }
  return socket;
}

std::uint16_t DatagramSocket::port() const {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  ::getsockname(socket_.value(), reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

std::optional<std::span<const std::byte>> DatagramSocket::Receive(std::span<std::byte> buffer,
                                                                  Endpoint* sender) noexcept {
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  const ssize_t count = ::recvfrom(socket_.value(), buffer.data(), buffer.size(), 0,
                                   reinterpret_cast<sockaddr*>(&address), &size);
  if (count < 0) {
    return std::nullopt;
  }
  *sender = {address.sin_addr.s_addr, address.sin_port};
  return buffer.first(static_cast<std::size_t>(count));
}

void DatagramSocket::Send(std::span<const std::byte> bytes, const Endpoint& receiver) noexcept {
  const sockaddr_in address = ToSystem(receiver);
  ::sendto(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&address), sizeof(address));
}

void DatagramSocket::WaitFor(int timeout_ms) const {
  pollfd waiting{socket_.value(), POLLIN, 0};
  ::poll(&waiting, 1, timeout_ms);
}

}  // namespace hvas::device
