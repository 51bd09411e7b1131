#include "base/clock.h"

namespace hvas {
namespace {

class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override { return MonotonicNs(); }
};

}  // namespace

const Clock& SystemClock() noexcept {
  static const MonotonicClock clock;
  return clock;
}

}  // namespace hvas
