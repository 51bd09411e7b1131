#pragma once

#include <filesystem>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas {

/** A folder of one's own under the system's temporary one, which nobody else may enter; it goes,
 with all that is in it, with its owner. Those of processes that were killed go when the next one is
 made. */
class ScratchFolder {
 public:
  /** Errors (kOutOfResource): no such folder can be made. */
  [[nodiscard]] static Result<ScratchFolder> Make();

  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&& other) noexcept;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  ScratchFolder(std::filesystem::path path, Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;  ///< Empty: there is none any more.
  Descriptor lock_;             ///< The folder; others see by its lock that the owner is alive.
};

}  // namespace hvas
