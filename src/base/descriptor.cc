#include "base/descriptor.h"

#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace hvas {

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    Close();
    value_ = std::exchange(other.value_, -1);
  }
  return *this;
}

bool Descriptor::Close() noexcept {
  return !is_open() || ::close(std::exchange(value_, -1)) == 0;
}

int TryLock(const Descriptor& file) noexcept {
  return ::flock(file.value(), LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
}

}  // namespace hvas
