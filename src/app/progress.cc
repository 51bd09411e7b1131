#include "app/progress.h"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "base/clock.h"

namespace hvas::app {
namespace {

constexpr std::int64_t kOftenestNs = 50'000'000;

}  // namespace

bool IsWatched() {
  return isatty(STDERR_FILENO) != 0;
}

void ShowProgress(std::string_view stage, double fraction) {
  static std::string last_stage;
  static std::int64_t last_ns = 0;
  const std::int64_t now_ns = MonotonicNs();
  if (fraction >= 1) {
    last_stage.clear();
    fmt::print(stderr, "\r\033[K");
  } else if (stage != last_stage || now_ns - last_ns >= kOftenestNs) {
    last_stage = stage;
    last_ns = now_ns;
    fmt::print(stderr, "\r\033[K{} {:.0f} %", stage, 100 * fraction);
  } else {
    return;
  }
  std::fflush(stderr);
}

}  // namespace hvas::app
