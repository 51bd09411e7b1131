#pragma once

#include <cstdint>

#include "base/clock.h"
#include "device/sample_guard.h"

namespace hvas::device {

/** A SampleGuard for devices that are polled. What a poll finds came at some time since the poll
 before, so that this is its age at worst, and the time that it is given; after a pause it counts as
 just not stale. RT-safe. */
class PolledGuard {
 public:
  PolledGuard(const DeviceProfile& profile, const Clock& clock);

  /** A poll begins; returns its time [ns]. */
  std::int64_t Begin() noexcept;

  /** The poll found this. Its time is set here. */
  [[nodiscard]] DeviceState Accept(DeviceState sample) noexcept;

  /** It found nothing new. */
  [[nodiscard]] DeviceState Repeat() noexcept;

  /** It found out that the device has no pose now, and why. */
  [[nodiscard]] DeviceState Refuse(Condition condition, std::int32_t vendor_code = 0) noexcept;

  /** What of a wrench may be shown after the last state: nothing when it was not ready, and never
   more than the profile allows. */
  [[nodiscard]] spatial::Wrench Permit(const spatial::Wrench& F_H_D) const noexcept;

  [[nodiscard]] bool is_ready() const noexcept { return is_ready_; }

 private:
  DeviceState Remember(DeviceState state) noexcept;

  const Clock& clock_;
  const DeviceProfile profile_;
  SampleGuard guard_;
  std::int64_t now_ns_;
  std::int64_t before_ns_;
  bool is_ready_{false};
};

/** The pose at p [m] with the quaternion that somebody sent, made a unit one; not a number where
 it is far from one, for a SampleGuard to refuse. RT-safe. */
[[nodiscard]] spatial::Pose PoseFromWire(const Quat& q, const Vec3& p) noexcept;

}  // namespace hvas::device
