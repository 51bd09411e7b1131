#pragma once

#include <filesystem>

#include "base/result.h"

namespace hvas::app {

/** Whether a command may write a file: nothing stands in its place, or it is to be replaced.
 Errors: kInvalid. */
[[nodiscard]] Result<void> CheckNewFile(const std::filesystem::path& file, bool is_forced);

}  // namespace hvas::app
