#include "device/drivers/unix_socket.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace hvas::device {
namespace {

constexpr int kBacklog = 8;  // Connections that wait: more than any test has.

/** False where the path is too long for a socket. */
bool MakeAddress(const char* path, sockaddr_un* address) noexcept {
  *address = {};
  address->sun_family = AF_UNIX;
  const std::size_t size = std::strlen(path);
  if (size >= sizeof(address->sun_path)) {
    errno = ENAMETOOLONG;
    return false;
  }
  std::memcpy(address->sun_path, path, size);
  return true;
}

}  // namespace

Descriptor TryConnect(const char* path, int type) noexcept {
  sockaddr_un address;
  if (!MakeAddress(path, &address)) {
    return {};
  }
  Descriptor socket(::socket(AF_UNIX, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto* plain = reinterpret_cast<const sockaddr*>(&address);
  if (!socket.is_open() || ::connect(socket.value(), plain, sizeof(address)) != 0) {
    const int reason = errno;
    socket.Close();
    errno = reason;
  }
  return socket;
}

Result<Descriptor> ListenAt(const std::filesystem::path& path, int type) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  std::filesystem::remove(path, ignored);
  sockaddr_un address;
  Descriptor listener(::socket(AF_UNIX, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto* plain = reinterpret_cast<const sockaddr*>(&address);
  if (!MakeAddress(path.c_str(), &address) || !listener.is_open() ||
      ::bind(listener.value(), plain, sizeof(address)) != 0 ||
      ::listen(listener.value(), kBacklog) != 0) {
    return Fail(ErrorCode::kOutOfResource,
                fmt::format("no socket can be made: {}", std::generic_category().message(errno)),
                path.string(), "set TMPDIR to a folder with a short name");
  }
  return listener;
}

Descriptor TryAccept(const Descriptor& listener) noexcept {
  return Descriptor(::accept4(listener.value(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
}

Transfer TryReceive(const Descriptor& from, std::span<std::byte> buffer,
                    std::size_t* count) noexcept {
  const ssize_t size = ::read(from.value(), buffer.data(), buffer.size());
  if (size > 0) {
    *count = static_cast<std::size_t>(size);
    return Transfer::kDone;
  }
  const bool is_waiting = size < 0 && (errno == EAGAIN || errno == EINTR);
  return is_waiting ? Transfer::kNothing : Transfer::kClosed;
}

}  // namespace hvas::device
