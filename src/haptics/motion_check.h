#pragma once

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

/** How far a body may go along its motion of a tick before it is deeper than allowed: a share of
 the motion, 0..1. The motion is looked at every kCheckStep, which is less than a thin wall, so that
 nothing passes through one unseen (conservative advancement: Mirtich, PhD thesis, Berkeley 1996).

 @param clearance  The least distance now; within it nothing can happen [m].
 @param travel  No point goes further in the whole motion [m].
 @param is_allowed  is_allowed(share): what is asked at a share of the motion, RT-safe.
 Calls it kMaxChecks times at most; a motion that needs more is cut short. RT-safe. */
template <typename IsAllowed>
[[nodiscard]] double FindFreeShare(double clearance, double travel,
                                   const IsAllowed& is_allowed) noexcept {
  constexpr double kCheckStep = 0.2e-3;  // [m], less than a thin wall: a choice.
  // The tick's time bounds the looks at a motion. Seventeen of them reach 3.4 mm, where it moves 1
  // mm at 1 m/s; three halve the last step, to 25 um. Choices.
  constexpr int kMaxChecks = 20;
  constexpr int kHalvings = 3;
  if (travel <= clearance) {
    return 1;
  }
  double share = std::max(0.0, clearance) / travel;
  const double step = kCheckStep / travel;
  for (int i = kHalvings; i < kMaxChecks && share < 1; ++i) {
    const double next = std::min(1.0, share + step);
    if (is_allowed(next)) {
      share = next;
      continue;
    }
    double blocked = next;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (share + blocked);
      (is_allowed(middle) ? share : blocked) = middle;
    }
    break;
  }
  return share;
}

}  // namespace hvas::haptics
