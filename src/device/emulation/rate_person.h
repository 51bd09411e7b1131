#pragma once

#include "device/drivers/rate_control.h"
#include "device/emulation/emulated_device.h"

namespace hvas::device {

/** How a person works a stick: watches where the integrated pose is and deflects towards where it
 should go, the further the more. What the driver integrates is integrated here alike. */
class RatePerson {
 public:
  explicit RatePerson(const Vec3& workspace) : seen_(workspace) {}

  /** The deflection that closes the way to X_DR, where the hand has come to without the stick. */
  [[nodiscard]] Deflection Deflect(const spatial::Pose& X_DR) const;

  /** That deflection, as the device sends it, has its effect for dt [s]. */
  void See(const Deflection& deflection, double dt) { seen_.Step(deflection, dt); }

  /** Where the integrated pose is. */
  [[nodiscard]] const spatial::Pose& X_DH() const { return seen_.X_DH(); }

 private:
  RateControl seen_;
};

}  // namespace hvas::device
