#pragma once

#include <filesystem>
#include <string_view>

#include "base/result.h"

namespace hvas {

/** Writes a whole file, or leaves what was there: a new file beside it, onto the disk, then renamed
 over it. Keeps the permissions of a file that is replaced, and writes through symbolic links.
 Errors: kNotFound (no such folder), kOutOfResource (disk full), kInvalid (not a file, no
 permission); each leaves no file behind. */
[[nodiscard]] Result<void> WriteAtomically(const std::filesystem::path& file,
                                           std::string_view bytes);

}  // namespace hvas
