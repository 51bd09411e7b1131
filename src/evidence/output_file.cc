#include "evidence/output_file.h"

#include <system_error>
#include <utility>

namespace hvas::evidence {

OutputFile::OutputFile(std::filesystem::path file, std::filesystem::path working_path)
    : file_(std::move(file)),
      working_path_(std::move(working_path)),
      stream_(working_path_, std::ios::binary | std::ios::trunc) {}

Result<OutputFile> OutputFile::Create(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    return Fail(ErrorCode::kInvalid, "exists and is not a file", file.string(),
                "choose another name");
  }
  const std::filesystem::path working_path = file.string() + ".part";
  std::filesystem::remove(working_path, ignored);  // A pipe of this name would be waited for.
  OutputFile output(file, working_path);
  if (!output.stream_) {
    return Fail(ErrorCode::kNotFound, "the file cannot be written", file.string(),
                "check that the folder exists and is writable");
  }
  return output;
}

OutputFile::~OutputFile() {
  if (stream_.is_open()) {
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(working_path_, ignored);
  }
}

Result<void> OutputFile::Finish() {
  stream_.flush();
  std::error_code failed;
  if (stream_) {
    std::filesystem::rename(working_path_, file_, failed);
  }
  if (!stream_ || failed) {
    return Fail(ErrorCode::kOutOfResource, "the file could not be written completely",
                file_.string(), "free disk space, or choose another folder");
  }
  stream_.close();
  return {};
}

}  // namespace hvas::evidence
