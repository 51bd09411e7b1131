#include "app/progress.h"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace hvas::app {

bool IsWatched() {
  return isatty(STDERR_FILENO) != 0;
}

void ShowProgress(std::string_view stage, double fraction) {
  if (fraction >= 1) {
    fmt::print(stderr, "\r\033[K");
  } else {
    fmt::print(stderr, "\r\033[K{} {:.0f} %", stage, 100 * fraction);
  }
  std::fflush(stderr);
}

}  // namespace hvas::app
