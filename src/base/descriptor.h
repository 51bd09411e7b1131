#pragma once

#include <utility>

namespace hvas {

/** A file descriptor that is closed with its owner. RT-safe, as far as closing the file is. */
class Descriptor {
 public:
  Descriptor() = default;

  /** @param value  What the system returned; a negative one makes a closed descriptor. */
  explicit Descriptor(int value) noexcept : value_(value) {}

  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}

  Descriptor& operator=(Descriptor&& other) noexcept;

  ~Descriptor() { Close(); }

  /** @returns false, with errno, when the system could not write what it had kept back; also then
   the descriptor is closed. */
  bool Close() noexcept;

  [[nodiscard]] int value() const noexcept { return value_; }

  [[nodiscard]] bool is_open() const noexcept { return value_ >= 0; }

 private:
  int value_{-1};
};

/** Locks an open file or folder against all who ask for its lock the same way, until the descriptor
 is closed or the process ends. Does not wait.
 @returns 0; EWOULDBLOCK when somebody else has the lock; or another errno. */
[[nodiscard]] int TryLock(const Descriptor& file) noexcept;

}  // namespace hvas
