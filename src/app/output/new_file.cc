#include "app/output/new_file.h"

#include <system_error>

namespace hvas::app {

Result<void> CheckNewFile(const std::filesystem::path& file, bool is_forced) {
  std::error_code ignored;
  if (!is_forced && std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) {
    return Fail(ErrorCode::kInvalid, "the file exists already", file.string(),
                "choose another name, or replace it with --force");
  }
  return {};
}

}  // namespace hvas::app
