#pragma once

#include <filesystem>
#include <string_view>

#include "base/result.h"

namespace hvas::app {

/** What can be known to fail before the work on a page: an ending other than .html and .pdf, or a
 file that is there and not to be replaced. Errors: kInvalid. */
[[nodiscard]] Result<void> CheckPageFile(const std::filesystem::path& file, bool is_forced);

/** Writes a page; as .pdf printed by Chromium. Errors: as WriteAtomically, kUnsupported where there
 is no Chromium or it fails. */
[[nodiscard]] Result<void> WritePage(const std::filesystem::path& file, std::string_view page);

}  // namespace hvas::app
