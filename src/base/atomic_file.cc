#include "base/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <span>
#include <string>
#include <system_error>

#include <fcntl.h>

#include "base/descriptor.h"
#include "base/write_all.h"

namespace hvas {
namespace {

Unexpected FailWith(int error, const std::filesystem::path& file) {
  ErrorCode code = ErrorCode::kInvalid;
  std::string remedy = "check the path and its permissions";
  if (error == ENOENT) {
    code = ErrorCode::kNotFound;
    remedy = "make the folder first, or choose another";
  } else if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    code = ErrorCode::kOutOfResource;
    remedy = "make room on the disk, or choose another";
  }
  return Fail(code,
              "cannot be written: " + std::error_code(error, std::generic_category()).message(),
              file.string(), std::move(remedy));
}

mode_t ModeFor(const std::filesystem::path& file, FileReaders readers) {
  if (readers == FileReaders::kOwner) {
    return S_IRUSR | S_IWUSR;
  }

  struct stat status {};

  if (::stat(file.c_str(), &status) == 0) {
    return status.st_mode & 07777U;
  }
  // There is no way to ask for the mask but to set it; a moment with a stricter one harms nobody.
  const mode_t mask = ::umask(077);
  ::umask(mask);
  return 0666U & ~mask;
}

}  // namespace

Result<void> WriteAtomically(const std::filesystem::path& file, std::string_view bytes,
                             FileReaders readers) {
  std::error_code error;
  std::filesystem::path target = file;
  if (std::filesystem::is_symlink(file, error)) {
    target = std::filesystem::canonical(file, error);
    if (error) {
      return FailWith(error.value(), file);
    }
  }
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error)) {
    return Fail(ErrorCode::kInvalid, "exists and is not a file", file.string(),
                "choose another name");
  }
  std::string name = target.string() + ".XXXXXX";  // The template that mkstemp(3) completes.
  Descriptor made(::mkstemp(name.data()));
  if (!made.is_open()) {
    return FailWith(errno, file);
  }
  int failure = WriteAll(made.value(), std::as_bytes(std::span(bytes)));
  if (failure == 0 &&
      (::fchmod(made.value(), ModeFor(target, readers)) != 0 || ::fsync(made.value()) != 0)) {
    failure = errno;
  }
  if (!made.Close() && failure == 0) {
    failure = errno;
  }
  if (failure == 0 && ::rename(name.c_str(), target.c_str()) != 0) {
    failure = errno;
  }
  if (failure != 0) {
    ::unlink(name.c_str());
    return FailWith(failure, file);
  }
  return {};
}

}  // namespace hvas
