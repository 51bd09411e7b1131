#pragma once

#include <array>
#include <cstddef>

#include "spatial/pose.h"

namespace hvas::haptics {

/** What counts as buzzing. A hand's tremor is at 8..12 Hz, tapping below 8; a loop that is not
 stable swings faster, and its force swings with it. */
struct BuzzThresholds {
  double speed{0.03};   ///< Swings that stay below, either way, are none [m/s] or [rad/s].
  double force{0.4};    ///< Change of the force within a swing, from end to end [N] or [N m].
  double window{0.16};  ///< Time in which `kReversals` reversals are too many [s]: 23 Hz or more.
};

/** Finds fast reversals of the hand's velocity together with those of its force, along each axis
 apart (OpenHaptics Programmer's Guide, "buzzing"). RT-safe. */
class BuzzDetector {
 public:
  /** Eight in the usual window: buzzing of 23 Hz or more. */
  static constexpr std::size_t kReversals = 8;

  explicit BuzzDetector(const BuzzThresholds& thresholds) noexcept : thresholds_(thresholds) {}

  /** One tick: velocity of the hand, and the force that it is given. True: it buzzes. */
  bool Update(const Vec3& v, const Vec3& f, double dt) noexcept;

  void Reset() noexcept { *this = BuzzDetector(thresholds_); }

 private:
  struct Axis {
    int sign{0};      ///< Present swing's.
    double f_min{0};  ///< Reached in this swing.
    double f_max{0};
    std::array<double, kReversals> times{};  ///< Times of the last reversals; a ring.
    std::size_t next{0};
    std::size_t count{0};
  };

  [[nodiscard]] bool UpdateAxis(double v, double f, Axis* axis) const noexcept;

  BuzzThresholds thresholds_;
  double time_{0};
  std::array<Axis, 3> axes_{};
};

}  // namespace hvas::haptics
