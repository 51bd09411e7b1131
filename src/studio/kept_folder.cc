#include "studio/kept_folder.h"

#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/digest.h"

namespace hvas::studio {
namespace {

namespace fs = std::filesystem;

Unexpected CannotKeep(const fs::path& file, int error) {
  return Fail(ErrorCode::kOutOfResource,
              "nothing can be kept here: " + std::generic_category().message(error), file.string(),
              "make room there, or set XDG_STATE_HOME to another folder");
}

/** A descriptor that has the lock; -1 when another program has it. */
Result<int> TryLock(const fs::path& file) {
  const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (lock < 0) {
    return CannotKeep(file, errno);
  }
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0) {
    return lock;
  }
  const int error = errno;
  ::close(lock);
  return error == EWOULDBLOCK ? Result<int>(-1) : Result<int>(CannotKeep(file, error));
}

Result<void> MakeOwnFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  return failed ? Result<void>(CannotKeep(folder, failed.value())) : Result<void>();
}

}  // namespace

Result<std::string> ReadKeptFile(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) {
    return Fail(errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kInvalid,
                "cannot be read: " + std::generic_category().message(errno), file.string(),
                "delete the file");
  }
  constexpr off_t kLargest = 64 << 20;

  struct stat status {};

  const bool is_own = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
                      (status.st_mode & (S_IRWXG | S_IRWXO)) == 0 && status.st_size <= kLargest;
  std::string text;
  std::array<char, 1 << 16> some{};
  ssize_t got = is_own ? 1 : 0;
  while (got > 0) {
    got = ::read(descriptor, some.data(), some.size());
    text.append(some.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  }
  ::close(descriptor);
  if (!is_own || got < 0) {
    return Fail(ErrorCode::kInvalid, "this is no file of this user's alone", file.string(),
                fmt::format("delete it, or: chmod 600 '{}'", file.string()));
  }
  return text;
}

Result<KeptFolder> KeptFolder::Take(const fs::path& parent, std::string_view subject) {
  if (const auto made = MakeOwnFolder(parent); !made) {
    return Unexpected(made.error());
  }
  Digest digest;
  digest.AddText(subject);
  constexpr int kMostAtOnce = 100;
  for (int i = 1; i <= kMostAtOnce; ++i) {
    fs::path path = parent / (i == 1 ? digest.Hex() : fmt::format("{}-{}", digest.Hex(), i));
    if (const auto made = MakeOwnFolder(path / "uploads"); !made) {
      return Unexpected(made.error());
    }
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_all, ignored);
    const auto lock = TryLock(path / "lock");
    if (!lock) {
      return Unexpected(lock.error());
    }
    if (*lock >= 0) {
      return KeptFolder(std::move(path), *lock);
    }
  }
  return CannotKeep(parent, EBUSY);
}

KeptFolder::KeptFolder(KeptFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

KeptFolder& KeptFolder::operator=(KeptFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  return *this;
}

KeptFolder::~KeptFolder() {
  if (lock_ >= 0) {
    ::close(lock_);
  }
}

void KeptFolder::RemoveUploadsBut(const fs::path& file) const {
  std::error_code ignored;
  for (const auto& item : fs::directory_iterator(uploads(), ignored)) {
    if (item.path() != file.parent_path()) {
      fs::remove_all(item.path(), ignored);
    }
  }
}

}  // namespace hvas::studio
