#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>

#include "base/result.h"

namespace hvas::evidence {

/** A large file that is written piece by piece beside its place, and put there when it is whole. */
class OutputFile {
 public:
  /** Errors: kNotFound where it cannot be written; kInvalid where something else than a file has
   this name. */
  static Result<OutputFile> Create(const std::filesystem::path& file);

  OutputFile(OutputFile&&) = default;
  OutputFile& operator=(OutputFile&&) = delete;
  /** Leaves nothing behind unless it was finished. */
  ~OutputFile();

  void Write(std::string_view text) {
    stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
  }

  /** Where a library writes by itself. */
  [[nodiscard]] const std::filesystem::path& working_path() const { return working_path_; }

  /** Errors: kOutOfResource when the disk did not take all of it. */
  Result<void> Finish();

 private:
  OutputFile(std::filesystem::path file, std::filesystem::path working_path);

  std::filesystem::path file_;
  std::filesystem::path working_path_;
  std::ofstream stream_;
};

}  // namespace hvas::evidence
