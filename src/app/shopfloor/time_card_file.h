#pragma once

#include <filesystem>

#include "base/result.h"
#include "shopfloor/motion_code.h"

namespace hvas::app {

/** Reads a card of times of the user's own: a table with the columns `code` and one of `seconds`,
 `tmu` (0.036 s) and `mod` (0.129 s). Other columns are left alone.
 Errors: those of CsvTable; kInvalid with the line for a code that begins with no letter or comes
 twice, or a time that is no number from 0 to 3600 s. */
[[nodiscard]] Result<shopfloor::TimeCard> ReadTimeCard(const std::filesystem::path& file);

}  // namespace hvas::app
