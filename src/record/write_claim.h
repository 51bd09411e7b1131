#pragma once

#include <filesystem>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::record {

/** Whether a new record can be written to a path, without touching anything.
 Errors: kInvalid when something is there that may not be replaced: anything but a record or an
 empty file; a record, unless `replaces`; a record that somebody is writing. */
[[nodiscard]] Result<void> CheckTarget(const std::filesystem::path& path, bool replaces);

/** The sole right to write a record, held as a lock on the file until the end of the object or of
 the process. */
class WriteClaim {
 public:
  /** Makes an empty file that only its owner can read, in place of what CheckTarget() allows.
   Errors: as CheckTarget(), and kNotFound where no file can be made. */
  [[nodiscard]] static Result<WriteClaim> Make(const std::filesystem::path& path, bool replaces);

  /** Errors: kNotFound when the path no longer leads to the file that was made. */
  [[nodiscard]] Result<void> CheckStillThere() const;

 private:
  WriteClaim(std::filesystem::path path, Descriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}

  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace hvas::record
