#include "base/regular_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

namespace hvas {
namespace {

std::string DescribeError(int error) {
  return std::error_code(error, std::generic_category()).message();
}

Unexpected FailToOpen(int error, const std::filesystem::path& path) {
  if (error == ENOENT || error == ENOTDIR) {
    return Fail(ErrorCode::kNotFound, "there is no such file", path.string(), "check the path");
  }
  return Fail(ErrorCode::kUnreadable,
              fmt::format("the file cannot be opened: {}", DescribeError(error)), path.string(),
              error == EACCES || error == EPERM ? "check its permissions" : "check the path");
}

const char* NameOfKind(mode_t mode) {
  if (S_ISDIR(mode)) {
    return "a folder";
  }
  if (S_ISFIFO(mode)) {
    return "a pipe";
  }
  return S_ISSOCK(mode) ? "a socket" : "a device";
}

Unexpected FailForKind(mode_t mode, const std::filesystem::path& path) {
  return Fail(ErrorCode::kUnreadable, fmt::format("this is {}, not a file", NameOfKind(mode)),
              path.string(),
              S_ISDIR(mode) ? "name a file in this folder"
                            : "copy its content into a file, and name that file");
}

/** Up to `most` bytes. */
Result<std::string> Read(const RegularFile& file, std::size_t most,
                         const std::filesystem::path& path) {
  // A file that grows while it is read gives what it has by then.
  constexpr std::size_t kStep = std::size_t{1} << 16;
  std::string text;
  text.reserve(std::min<std::uintmax_t>(file.size() + 1, most));  // One more, to see its end.
  while (text.size() < most) {
    const std::size_t before = text.size();
    text.resize(std::min(most, before < text.capacity() ? text.capacity() : before + kStep));
    const ssize_t size = ::read(file.descriptor(), text.data() + before, text.size() - before);
    const int error = errno;
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    if (size == 0) {
      break;
    }
    if (size < 0 && error != EINTR) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("the file cannot be read: {}", DescribeError(error)), path.string(),
                  "check the disk");
    }
  }
  return text;
}

}  // namespace

Result<RegularFile> RegularFile::Open(const std::filesystem::path& path) {
  struct stat status {};

  if (::stat(path.c_str(), &status) != 0) {
    return FailToOpen(errno, path);
  }
  if (!S_ISREG(status.st_mode)) {
    return FailForKind(status.st_mode, path);
  }
  // What stands there may have become something else since then.
  return Take(Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)), path);
}

Result<RegularFile> RegularFile::Take(Descriptor file, const std::filesystem::path& path) {
  struct stat status {};

  if (!file.is_open() || ::fstat(file.value(), &status) != 0) {
    return FailToOpen(errno, path);
  }
  if (!S_ISREG(status.st_mode)) {
    return FailForKind(status.st_mode, path);
  }
  return RegularFile(std::move(file), static_cast<std::uintmax_t>(status.st_size));
}

Result<void> CheckRegularFile(const std::filesystem::path& path) {
  if (const auto file = RegularFile::Open(path); !file) {
    return Unexpected(file.error());
  }
  return {};
}

Result<std::string> ReadFileHead(const std::filesystem::path& path, std::size_t most) {
  const auto file = RegularFile::Open(path);
  return file ? Read(*file, most, path) : Unexpected(file.error());
}

Result<std::string> ReadRegularFile(const std::filesystem::path& path, std::size_t largest) {
  const auto file = RegularFile::Open(path);
  return file ? ReadRegularFile(*file, path, largest) : Unexpected(file.error());
}

Result<std::string> ReadRegularFile(const RegularFile& file, const std::filesystem::path& path,
                                    std::size_t largest) {
  auto text = Read(file, largest + 1, path);
  if (text && text->size() > largest) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the file is larger than the limit of {} bytes", largest),
                path.string(), "remove what does not belong into it");
  }
  return text;
}

}  // namespace hvas
