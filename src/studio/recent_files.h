#pragma once

#include <filesystem>
#include <vector>

namespace hvas::studio {

inline constexpr std::size_t kMaxRecentFiles = 6;  ///< The start page shows so many: a choice.

/** Reads which CAD files were opened last, newest first; those that are gone are left out. A list
 that is missing or damaged is empty. */
[[nodiscard]] std::vector<std::filesystem::path> LoadRecentFiles(const std::filesystem::path& list);

/** Puts a file at the top of the list, which only this user can read. A list that cannot be written
 stays as it is: nothing depends on it. */
void NoteRecentFile(const std::filesystem::path& list, const std::filesystem::path& file);

}  // namespace hvas::studio
