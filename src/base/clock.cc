#include "base/clock.h"

namespace hvas {
namespace {

class BootClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override { return BootTimeNs(); }
};

}  // namespace

const Clock& SystemClock() noexcept {
  static const BootClock clock;
  return clock;
}

}  // namespace hvas
