#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include <linux/input.h>

#include "device/drivers/unix_socket.h"

namespace hvas::device {

/** An input device of the kernel: dev/input/eventN. Where the node is a UNIX socket instead,
 someone else stands for the kernel: events are packets on it, and ioctl calls are packets on a
 second socket beside it (EvdevCall, then its data; answered by EvdevAnswer, then its data). So a
 device can be shown without /dev/uinput. */
class EvdevNode {
 public:
  /** Ending of the second socket's name. */
  static constexpr const char* kCalls = ".ioctl";

  EvdevNode() = default;

  /** Opens it without waiting; a closed one when that fails, with errno. */
  static EvdevNode TryOpen(const std::filesystem::path& path);

  [[nodiscard]] bool is_open() const noexcept { return events_.is_open(); }

  /** ioctl(); -1 with errno on failure. May wait. */
  int Call(unsigned long request, void* data) const noexcept;

  /** Events that are there. RT-safe. */
  [[nodiscard]] Transfer TryReceive(std::span<input_event> events,
                                    std::size_t* count) const noexcept;

  /** Gives the device events (force feedback); lost when it has no room. RT-safe. */
  void Send(std::span<const input_event> events) const noexcept;

 private:
  Descriptor events_;
  Descriptor calls_;  // open where the node is a socket
};

struct EvdevCall {
  std::uint64_t request;
};

struct EvdevAnswer {
  std::int32_t result;
  std::int32_t error;
};

/** Why a node cannot be opened, and what to do about it. */
[[nodiscard]] Error EvdevProblem(int reason, const std::filesystem::path& path);

}  // namespace hvas::device
