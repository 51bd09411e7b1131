#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace hvas::device::testing {

/** A folder that stands for the root of a machine, and goes with its owner. */
class WireFolder {
 public:
  WireFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hvas-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }

  WireFolder(const WireFolder&) = delete;
  WireFolder& operator=(const WireFolder&) = delete;

  ~WireFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  [[nodiscard]] std::string Path(const std::string& name) const { return (path_ / name).string(); }

  /** Returns the file's path. */
  std::string Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream stream(path_ / name, std::ios::binary);
    stream << text;
    return Path(name);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace hvas::device::testing
