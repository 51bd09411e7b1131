#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::studio {

/** A file that a client sends. One thread at a time; Create() and Add() access the disk. */
class UploadFile {
 public:
  explicit UploadFile(std::filesystem::path path) : path_(std::move(path)) {}

  /** Makes the file, for its owner only. Errors: kOutOfResource. */
  [[nodiscard]] Result<void> Create();

  /** Adds bytes. Errors: kOutOfResource on a full disk. */
  [[nodiscard]] Result<void> Add(std::span<const std::byte> bytes);

  void Close() { file_.Close(); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace hvas::studio
