#include "studio/state_folder.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/digest.h"
#include "base/regular_file.h"

namespace hvas::studio {
namespace {

namespace fs = std::filesystem;

Unexpected FailToWrite(const fs::path& file, int error) {
  return Fail(ErrorCode::kOutOfResource,
              "this folder cannot be written: " + std::generic_category().message(error),
              file.string(), "free disk space there, or set XDG_STATE_HOME to another folder");
}

/** Opens and locks a file; the descriptor is closed when another process has the lock. */
Result<Descriptor> LockFile(const fs::path& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  const int error = file.is_open() ? TryLock(file) : errno;
  if (error == EWOULDBLOCK) {
    return Descriptor();
  }
  return error == 0 ? Result<Descriptor>(std::move(file)) : FailToWrite(path, error);
}

Result<void> MakeOwnFolder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  return failed ? Result<void>(FailToWrite(folder, failed.value())) : Result<void>();
}

}  // namespace

Result<std::string> ReadPrivateFile(const fs::path& path) {
  Descriptor opened(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!opened.is_open()) {
    return Fail(errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kInvalid,
                "cannot be read: " + std::generic_category().message(errno), path.string(),
                "delete the file");
  }
  const auto file = RegularFile::Take(std::move(opened), path);

  struct stat status {};

  if (!file || ::fstat(file->descriptor(), &status) != 0 ||
      (status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Fail(ErrorCode::kInvalid, "the file is not accessible to this user only", path.string(),
                fmt::format("delete it, or run: chmod 600 '{}'", path.string()));
  }
  // [bytes] of a file that is kept: a choice.
  constexpr std::size_t kLargest = std::size_t{64} << 20U;
  return ReadRegularFile(*file, path, kLargest);
}

Result<StateFolder> StateFolder::Take(const fs::path& parent, std::string_view subject) {
  if (const auto made = MakeOwnFolder(parent); !made) {
    return Unexpected(made.error());
  }
  Digest digest;
  digest.AddText(subject);
  constexpr int kMaxAtOnce = 100;  // Studios on one subject: a choice.
  for (int i = 1; i <= kMaxAtOnce; ++i) {
    fs::path path = parent / (i == 1 ? digest.Hex() : fmt::format("{}-{}", digest.Hex(), i));
    if (const auto made = MakeOwnFolder(path / "uploads"); !made) {
      return Unexpected(made.error());
    }
    std::error_code ignored;
    fs::permissions(path, fs::perms::owner_all, ignored);
    auto lock = LockFile(path / "lock");
    if (!lock) {
      return Unexpected(lock.error());
    }
    if (lock->is_open()) {
      return StateFolder(std::move(path), std::move(*lock));
    }
  }
  return FailToWrite(parent, EBUSY);
}

void StateFolder::RemoveUploadsBut(const fs::path& file) const {
  std::error_code ignored;
  for (const auto& item : fs::directory_iterator(uploads(), ignored)) {
    if (item.path() != file.parent_path()) {
      fs::remove_all(item.path(), ignored);
    }
  }
}

}  // namespace hvas::studio
