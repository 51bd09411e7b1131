#include "base/scratch_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <stdlib.h>

namespace hvas {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPrefix = "hvas-own-";
constexpr std::string_view kRandom = "XXXXXX";  // The end of a template that mkdtemp(3) completes.
// A younger folder may be of a process that has not locked it yet.
constexpr std::chrono::minutes kYoungest{1};

/** The folder, locked; closed where it is not this user's, or its owner is alive. */
Descriptor Lock(const fs::path& path) {
  Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));

  struct stat status {};

  const bool is_ours = folder.is_open() && ::fstat(folder.value(), &status) == 0 &&
                       status.st_uid == ::geteuid() && TryLock(folder) == 0;
  return is_ours ? std::move(folder) : Descriptor();
}

void RemoveOrphans(const fs::path& parent) {
  std::error_code failed;
  const auto now = fs::file_time_type::clock::now();
  for (fs::directory_iterator at(parent, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if (!name.starts_with(kPrefix) || name.size() != kPrefix.size() + kRandom.size() ||
        now - fs::last_write_time(at->path(), ignored) < kYoungest || ignored) {
      continue;
    }
    if (const Descriptor orphan = Lock(at->path()); orphan.is_open()) {
      fs::remove_all(at->path(), ignored);
    }
  }
}

}  // namespace

Result<ScratchFolder> ScratchFolder::Make() {
  std::error_code failure;
  const fs::path parent = fs::temp_directory_path(failure);
  std::string name = (parent / kPrefix).string() + std::string(kRandom);
  if (failure || ::mkdtemp(name.data()) == nullptr) {
    return Fail(ErrorCode::kOutOfResource, "no temporary folder can be made", name,
                "make room in the temporary folder, or set TMPDIR to another one");
  }
  ScratchFolder folder(name, Lock(name));
  RemoveOrphans(parent);
  return folder;
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), lock_(std::move(other.lock_)) {}

ScratchFolder& ScratchFolder::operator=(ScratchFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  return *this;
}

ScratchFolder::~ScratchFolder() {
  if (!path_.empty()) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
}

}  // namespace hvas
