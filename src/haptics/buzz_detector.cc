#include "haptics/buzz_detector.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

bool BuzzDetector::Update(const Vec3& v, const Vec3& f, double dt) noexcept {
  time_ += dt;
  bool is_buzzing = false;
  for (int k = 0; k < 3; ++k) {
    is_buzzing |= UpdateAxis(v[k], f[k], &axes_[static_cast<std::size_t>(k)]);
  }
  return is_buzzing;
}

bool BuzzDetector::UpdateAxis(double v, double f, Axis* axis) const noexcept {
  axis->f_min = std::min(axis->f_min, f);
  axis->f_max = std::max(axis->f_max, f);
  const int sign = v > 0 ? 1 : -1;
  if (std::abs(v) < thresholds_.speed || sign == axis->sign) {
    return false;
  }
  const bool is_reversal = axis->sign != 0 && axis->f_max - axis->f_min >= thresholds_.force;
  axis->sign = sign;
  axis->f_min = axis->f_max = f;
  if (!is_reversal) {
    return false;
  }
  axis->times[axis->next] = time_;
  axis->next = (axis->next + 1) % kReversals;
  axis->count = std::min(axis->count + 1, kReversals);
  // The ring's next place holds the oldest.
  return axis->count == kReversals && time_ - axis->times[axis->next] <= thresholds_.window;
}

}  // namespace hvas::haptics
