#include "studio/upload_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/write_all.h"

namespace hvas::studio {
namespace {

Unexpected FailToSave(int error, const std::filesystem::path& path) {
  return Fail(ErrorCode::kOutOfResource,
              fmt::format("the file cannot be saved: {}", std::strerror(error)),
              path.filename().string(), "free disk space");
}

}  // namespace

Result<void> UploadFile::Create() {
  file_ =
      Descriptor(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR));
  return file_.is_open() ? Result<void>() : FailToSave(errno, path_);
}

Result<void> UploadFile::Add(std::span<const std::byte> bytes) {
  const int error = WriteAll(file_.value(), bytes);
  return error == 0 ? Result<void>() : FailToSave(error, path_);
}

}  // namespace hvas::studio
