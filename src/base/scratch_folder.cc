#include "base/scratch_folder.h"

#include <string>
#include <system_error>
#include <utility>

#include <stdlib.h>

namespace hvas {

Result<ScratchFolder> ScratchFolder::Make() {
  std::error_code failure;
  std::string name = (std::filesystem::temp_directory_path(failure) / "hvas-XXXXXX").string();
  // mkdtemp puts letters of its own for the six X.
  if (failure || ::mkdtemp(name.data()) == nullptr) {
    return Fail(ErrorCode::kOutOfResource, "no temporary folder can be made", name,
                "make room in the temporary folder, or set TMPDIR to another one");
  }
  return ScratchFolder(std::filesystem::path(name));
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept : path_(std::move(other.path_)) {
  other.path_.clear();
}

ScratchFolder& ScratchFolder::operator=(ScratchFolder&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

ScratchFolder::~ScratchFolder() {
  if (!path_.empty()) {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
}

}  // namespace hvas
