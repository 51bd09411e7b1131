#include "base/clock.h"

namespace hvas {
namespace {

/** Time since the machine started, with the time for which it was suspended: what was computed
 before a suspension is as old as it is for the world. */
class BootClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override { return ReadClock(CLOCK_BOOTTIME); }
};

}  // namespace

const Clock& SystemClock() noexcept {
  static const BootClock clock;
  return clock;
}

}  // namespace hvas
