#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "base/scratch_folder.h"

namespace hvas::testing {

/** A folder of its own that goes, with all that is in it, when the object goes. */
class TemporaryFolder {
 public:
  [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }

  [[nodiscard]] std::filesystem::path operator/(const std::filesystem::path& name) const {
    return path() / name;
  }

  /** Writes a file there, byte for byte; makes the folders before it. */
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::filesystem::path file = path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  ScratchFolder folder_{ScratchFolder::Make().value()};
};

}  // namespace hvas::testing
