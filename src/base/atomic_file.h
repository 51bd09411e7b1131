#pragma once

#include <filesystem>
#include <string_view>

#include "base/result.h"

namespace hvas {

/** Who may read a file that is written. */
enum class FileReaders {
  kAsBefore,  ///< Those of a file that is replaced; for a new one, those that the user's mask
              ///< allows.
  kOwner,     ///< Nobody else, at no moment.
};

/** Writes a whole file, or leaves what was there: a new file beside it, onto the disk, then renamed
 over it. Writes through symbolic links.
 Errors: kNotFound (no such folder), kOutOfResource (disk full), kInvalid (not a file, no
 permission); each leaves no file behind. */
[[nodiscard]] Result<void> WriteAtomically(const std::filesystem::path& file,
                                           std::string_view bytes,
                                           FileReaders readers = FileReaders::kAsBefore);

}  // namespace hvas
