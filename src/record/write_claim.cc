#include "record/write_claim.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>

#include "record/database.h"
#include "record/session_file.h"

namespace hvas::record {
namespace {

constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;

/** Whether it is a record, or an empty database: what is left of a writer that was killed early. */
bool IsRecord(const std::filesystem::path& path) {
  Result<Database> database = Database::Open(path, Database::Mode::kReadOnly);
  return database && (database->QueryInt("PRAGMA application_id").value_or(0) == kApplicationId ||
                      database->QueryInt("SELECT count(*) FROM sqlite_master").value_or(1) == 0);
}

/** Whether another program, or another recorder of this one, has the lock. A file system that has
 no locks is written to without. */
bool IsLockedByOthers(const Descriptor& file) {
  return TryLock(file) == EWOULDBLOCK;
}

Unexpected FailAsWritten(const std::filesystem::path& path) {
  return Fail(ErrorCode::kInvalid, "another session is being recorded to this file", path.string(),
              "choose another file name, or end that session");
}

Unexpected FailToMake(int cause, const std::filesystem::path& path) {
  return Fail(cause == ENOSPC ? ErrorCode::kOutOfResource : ErrorCode::kNotFound,
              std::string("the record cannot be made: ") + std::strerror(cause), path.string(),
              "check that the folder exists and is writable");
}

/** Removes what is at the path, unless somebody writes to it. Who reads it can read on. */
Result<void> RemoveUnwritten(const std::filesystem::path& path) {
  const Descriptor old(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!old.is_open()) {
    return {};
  }
  if (IsLockedByOthers(old)) {
    return FailAsWritten(path);
  }
  for (const char* suffix : {"-wal", "-shm", "-journal", ""}) {
    if (::unlink((path.string() + suffix).c_str()) != 0 && errno != ENOENT) {
      return FailToMake(errno, path);
    }
  }
  return {};
}

}  // namespace

Result<void> CheckTarget(const std::filesystem::path& path, bool replaces) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) {
    return {};
  }
  if (!std::filesystem::is_regular_file(status) ||
      (std::filesystem::file_size(path, ignored) > 0 && !IsRecord(path))) {
    return Fail(ErrorCode::kInvalid,
                "the existing file is not a session record and is not replaced", path.string(),
                "choose another file name");
  }
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.is_open() && IsLockedByOthers(file)) {
    return FailAsWritten(path);
  }
  if (std::filesystem::file_size(path, ignored) > 0 && !replaces) {
    return Fail(ErrorCode::kInvalid, "the file has the record of another session", path.string(),
                "choose another file name, or replace it with --force");
  }
  return {};
}

Result<WriteClaim> WriteClaim::Make(const std::filesystem::path& path, bool replaces) {
  if (const Result<void> checked = CheckTarget(path, replaces); !checked) {
    return Unexpected(checked.error());
  }
  if (const Result<void> removed = RemoveUnwritten(path); !removed) {
    return Unexpected(removed.error());
  }
  Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kOwnerOnly));
  if (!file.is_open()) {
    return errno == EEXIST ? FailAsWritten(path) : FailToMake(errno, path);
  }
  const bool is_taken = IsLockedByOthers(file);
  WriteClaim claim(path, std::move(file));
  if (is_taken || !claim.CheckStillThere()) {  // somebody else made the same file at this moment
    return FailAsWritten(path);
  }
  return claim;
}

Result<void> WriteClaim::CheckStillThere() const {
  struct stat made {};

  struct stat found {};

  const bool is_there = ::fstat(file_.value(), &made) == 0 && ::stat(path_.c_str(), &found) == 0 &&
                        made.st_dev == found.st_dev && made.st_ino == found.st_ino;
  if (!is_there) {
    return Fail(ErrorCode::kNotFound, "the record was removed or replaced during recording",
                path_.string(), "record the rest of the session to another file");
  }
  return {};
}

}  // namespace hvas::record
