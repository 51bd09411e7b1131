#include "base/file_lock.h"

#include <sys/stat.h>

#include <cerrno>

#include <fcntl.h>

namespace hvas {

Descriptor OpenLocked(const std::filesystem::path& path, mode_t mode, int* error) {
  for (;;) {
    Descriptor file(::open(
        path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, mode));

    struct stat opened {};

    struct stat found {};

    if (!file.is_open() || ::fstat(file.value(), &opened) != 0) {
      *error = errno;
      return {};
    }
    if (!S_ISREG(opened.st_mode)) {
      *error = EINVAL;
      return {};
    }
    if (TryLock(file) == EWOULDBLOCK) {
      *error = EWOULDBLOCK;
      return {};
    }
    // Whoever had the lock until now may have removed or renamed the file.
    if (::stat(path.c_str(), &found) == 0 && found.st_dev == opened.st_dev &&
        found.st_ino == opened.st_ino) {
      *error = 0;
      return file;
    }
  }
}

}  // namespace hvas
