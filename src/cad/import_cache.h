#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "base/file_cache.h"
#include "cad/import.h"
#include "cad/import_result.h"

namespace hvas::cad {

/** What was made of CAD files, on disk, by the content that it was made from: of the file, of those
 that it refers to (also when they were missing), the options, and the program that read them.

 What cannot be read (damaged, cut short, of another version) is as good as absent; a directory that
 cannot be written to costs time and nothing else. Several programs may use one directory at once.
 */
class ImportCache {
 public:
  /** @param directory  Made when the first product is written.
   @param worker  The program that reads: what another build of it made is not taken.
   @param file  The CAD file, absolute.
   @param capacity  Of all products in the directory [bytes]; beyond it the oldest go. */
  ImportCache(std::filesystem::path directory, const std::filesystem::path& worker,
              std::filesystem::path file, const ImportOptions& options,
              std::uintmax_t capacity = FileCache::kDefaultCapacity);

  /** What was made of the file as it is now, to the last bit. */
  [[nodiscard]] std::optional<ImportResult> Load() const;

  /** Keeps a serialised ImportResult. @returns false where it cannot be kept. */
  bool Store(std::span<const std::byte> result) const;

  /** The file that holds, or would hold, the result. */
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  [[nodiscard]] bool AreUnchanged(const std::vector<ReferredFile>& files) const;

  FileCache files_;
  std::filesystem::path file_;
  std::string key_;
  std::filesystem::path path_;
};

}  // namespace hvas::cad
