#include "device/drivers/evdev_node.h"

#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>

namespace hvas::device {
namespace {

// The bytes of the longest answer, and the time that an emulator has for one: choices.
constexpr std::size_t kMaxData = 256;
constexpr int kAnswerTimeout_ms = 2000;

/** An ioctl by way of a socket. */
int CallThrough(const Descriptor& calls, unsigned long request, void* data) noexcept {
  const std::size_t size = _IOC_SIZE(request);
  std::array<std::byte, sizeof(EvdevCall) + kMaxData> out{};
  std::array<std::byte, sizeof(EvdevAnswer) + kMaxData> in{};
  const EvdevCall call{request};
  errno = EIO;
  if (size > kMaxData) {
    return -1;
  }
  std::memcpy(out.data(), &call, sizeof(call));
  if ((_IOC_DIR(request) & _IOC_WRITE) != 0) {
    std::memcpy(out.data() + sizeof(call), data, size);
  }
  pollfd waiting{calls.value(), POLLIN, 0};
  std::size_t count = 0;
  if (::send(calls.value(), out.data(), sizeof(call) + size, MSG_NOSIGNAL) < 0 ||
      ::poll(&waiting, 1, kAnswerTimeout_ms) != 1 ||
      TryReceive(calls, in, &count) != Transfer::kDone || count < sizeof(EvdevAnswer)) {
    return -1;
  }
  EvdevAnswer answer{};
  std::memcpy(&answer, in.data(), sizeof(answer));
  if (answer.result >= 0 && data != nullptr) {
    std::memcpy(data, in.data() + sizeof(answer), std::min(size, count - sizeof(answer)));
  }
  errno = answer.error;
  return answer.result;
}

}  // namespace

EvdevNode EvdevNode::TryOpen(const std::filesystem::path& path) {
  EvdevNode node;

  struct stat status {};

  if (::stat(path.c_str(), &status) != 0) {
    return node;
  }
  if (S_ISSOCK(status.st_mode)) {
    node.events_ = TryConnect(path.c_str(), SOCK_SEQPACKET);
    node.calls_ = TryConnect((path.string() + kCalls).c_str(), SOCK_SEQPACKET);
    return node.calls_.is_open() ? std::move(node) : EvdevNode();
  }
  // Without the right to write there is no rumble, but still a pose.
  constexpr int kFlags = O_NONBLOCK | O_CLOEXEC;
  node.events_ = Descriptor(::open(path.c_str(), O_RDWR | kFlags));
  if (!node.is_open() && errno == EACCES) {
    node.events_ = Descriptor(::open(path.c_str(), O_RDONLY | kFlags));
  }
  return node;
}

int EvdevNode::Call(unsigned long request, void* data) const noexcept {
  return calls_.is_open() ? CallThrough(calls_, request, data)
                          : ::ioctl(events_.value(), request, data);
}

Transfer EvdevNode::TryReceive(std::span<input_event> events, std::size_t* count) const noexcept {
  std::size_t size = 0;
  const Transfer transfer = device::TryReceive(events_, std::as_writable_bytes(events), &size);
  *count = size / sizeof(input_event);
  return transfer;
}

void EvdevNode::Send(std::span<const input_event> events) const noexcept {
  const iovec piece{const_cast<input_event*>(events.data()), events.size_bytes()};
  [[maybe_unused]] const ssize_t count = ::writev(events_.value(), &piece, 1);
}

Error EvdevProblem(int reason, const std::filesystem::path& path) {
  switch (reason) {
    case EACCES:
    case EPERM:
      return {ErrorCode::kInvalid, "this user has no permission to use this input device",
              path.string(),
              "join the group input and log in again: sudo usermod -aG input $USER; or give the "
              "local user access by a udev rule: SUBSYSTEM==\"input\", "
              "ENV{ID_INPUT_JOYSTICK}==\"1\", TAG+=\"uaccess\""};
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return {ErrorCode::kNotFound, "there is no such input device", path.string(),
              "connect it, or omit the address to use the first one found"};
    default:
      return {ErrorCode::kOutOfResource,
              fmt::format("the input device cannot be opened: {}",
                          std::generic_category().message(reason)),
              path.string(), "disconnect it and connect it again"};
  }
}

}  // namespace hvas::device
