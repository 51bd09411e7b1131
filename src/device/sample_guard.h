#pragma once

#include <cstdint>

#include "device/device.h"

namespace hvas::device {

/** A sample or a wrench of this age still counts [ns]; a device that is given nothing for longer
 lets go. A choice, as the vendors' threads hold a wrench (docs/realtime.md). */
inline constexpr std::int64_t kAgeHeldNs = 20'000'000;

/** Judges what a vendor's software gives before anybody believes it: finite, fresh, and no further
 from the last sample than a hand moves. Every driver passes its samples through one. RT-safe. */
class SampleGuard {
 public:
  /** A hand reaches 3 m/s and 30 rad/s in the fastest reaches; beyond that it is not the hand. */
  static constexpr double kMaxSpeed = 5;      ///< [m/s]
  static constexpr double kMaxTurnRate = 60;  ///< [rad/s]
  /** How long a device may be without a new sample until it is stale. */
  static constexpr std::int64_t kStaleNs = 3'500'000;
  /** How long it has to be plausible after an implausible sample to be believed again. */
  static constexpr std::int64_t kSettleNs = 50'000'000;

  /** @param resolution  A jump of a few of the device's own steps is none [m], [rad]. */
  SampleGuard(double resolution, double rotation_resolution)
      : slack_(8 * resolution), turn_slack_(8 * rotation_resolution) {}

  /** A driver has a new sample with its own condition; returns it as it may be passed on. The first
   button or a closed grip grips, the second button clutches. */
  [[nodiscard]] DeviceState Accept(const DeviceState& sample) noexcept;

  /** There is none; returns the last one, marked as stale when it is too old. Its velocity fades.
   */
  [[nodiscard]] DeviceState Repeat(std::int64_t now_ns) noexcept;

 private:
  double slack_;
  double turn_slack_;
  DeviceState last_{};
  bool has_last_{false};
  bool is_settling_{false};
  std::int64_t settled_ns_{0};  ///< When it may be believed again.
};

/** Share of a wrench of some age that a device's own thread may still show: all of it for 20 ms,
 then linearly down to nothing in 50 ms, so that no force outlives who computed it (N6). RT-safe. */
[[nodiscard]] double ShareOfAge(std::int64_t age_ns) noexcept;

/** What a device's own thread may still show of the wrench that it was given last. After that
 thread stood still it shows nothing of what was given before: the device has let go by then, and
 the force would be back at once. One thread; RT-safe. */
class ForceHold {
 public:
  /** Share of a wrench, as the thread is about to show it.
   @param given_ns,now_ns  By one clock. */
  [[nodiscard]] double CalcShare(std::int64_t given_ns, std::int64_t now_ns) noexcept;

 private:
  std::int64_t shown_ns_{0};  ///< Time of the last call.
  std::int64_t valid_ns_{0};  ///< What was given before is void.
};

}  // namespace hvas::device
