#pragma once

#include <string_view>

namespace hvas::app {

/** True where a person watches stderr: progress is for them only. */
[[nodiscard]] bool IsWatched();

/** One line on a terminal that is written over, and gone when the fraction reaches 1. Not written
 more often than the eye can follow. One thread at a time. */
void ShowProgress(std::string_view stage, double fraction);

}  // namespace hvas::app
