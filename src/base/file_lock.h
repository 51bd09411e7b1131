#pragma once

#include <sys/types.h>

#include <filesystem>

#include "base/descriptor.h"

namespace hvas {

/** Opens a file for writing, which is made where there is none, and locks it as TryLock() does.
 Where the file system has no locks, it is open without one.
 @param mode  Permissions of a file that is made, less the user's mask.
 @param error  Gets 0; EWOULDBLOCK when somebody else has the lock; or another errno.
 @returns the file that has this name while it is locked; closed where there is an error. */
[[nodiscard]] Descriptor OpenLocked(const std::filesystem::path& path, mode_t mode, int* error);

}  // namespace hvas
