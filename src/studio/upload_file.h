#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::studio {

/** A file that a client sends, in a folder of its own, which is removed with the object unless the
 file was kept. One thread at a time; all functions but the constructor access the disk. */
class UploadFile {
 public:
  /** @param name  Of the file; harmless. */
  UploadFile(std::filesystem::path folder, std::string name)
      : folder_(std::move(folder)), name_(std::move(name)) {}

  UploadFile(const UploadFile&) = delete;
  UploadFile& operator=(const UploadFile&) = delete;
  ~UploadFile();

  /** Makes the folder and the file. Errors: kOutOfResource. */
  [[nodiscard]] Result<void> Create();

  /** Adds bytes. Errors: kOutOfResource on a full disk. */
  [[nodiscard]] Result<void> Add(std::span<const std::byte> bytes);

  /** Closes the file, which stays. @returns its path. */
  std::filesystem::path Keep();

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::filesystem::path folder_;
  std::string name_;
  Descriptor file_;
  bool is_kept_{false};
};

}  // namespace hvas::studio
