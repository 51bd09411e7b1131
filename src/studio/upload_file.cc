#include "studio/upload_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/write_all.h"

namespace hvas::studio {
namespace {

Unexpected FailToSave(const std::string& reason, const std::string& name) {
  return Fail(ErrorCode::kOutOfResource, fmt::format("the file cannot be saved: {}", reason), name,
              "free disk space");
}

}  // namespace

UploadFile::~UploadFile() {
  if (!is_kept_) {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
}

Result<void> UploadFile::Create() {
  std::error_code failed;
  std::filesystem::create_directory(folder_, failed);
  if (failed) {
    return FailToSave(failed.message(), name_);
  }
  file_ = Descriptor(::open((folder_ / name_).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                            S_IRUSR | S_IWUSR));
  return file_.is_open() ? Result<void>() : FailToSave(std::strerror(errno), name_);
}

Result<void> UploadFile::Add(std::span<const std::byte> bytes) {
  const int error = WriteAll(file_.value(), bytes);
  return error == 0 ? Result<void>() : FailToSave(std::strerror(error), name_);
}

std::filesystem::path UploadFile::Keep() {
  file_.Close();
  is_kept_ = true;
  return folder_ / name_;
}

}  // namespace hvas::studio
