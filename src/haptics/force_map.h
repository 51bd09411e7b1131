#pragma once

#include <cmath>

#include "device/device.h"

namespace hvas::haptics {

/** The one map from true to felt magnitudes (N4, W9), the same for every fit:

     felt(F) = F                       for F <= F_lin
     felt(F) = F_lin (1 + ln(F/F_lin)) above,

 continuous with a continuous slope, strictly increasing, hence invertible: the hand can tell any
 two forces apart that differ enough, and the true force is known from the felt one. F_lin follows
 from one statement about the device: the largest true force of interest is felt at its full
 force. Nothing in it depends on the parts. */
class ForceMap {
 public:
  /** @param largest_true  True magnitude to be felt as `largest_felt` [N or N m]; greater than it.
   @param largest_felt  What the device can give [N or N m]; 0: nothing is felt. */
  ForceMap(double largest_true, double largest_felt);

  /** Felt magnitude of a true magnitude >= 0. RT-safe. */
  [[nodiscard]] double Felt(double true_magnitude) const noexcept;
  /** Inverse of Felt. RT-safe. */
  [[nodiscard]] double True(double felt_magnitude) const noexcept;

  /** Both of forces along a line, whose sign stays. RT-safe. */
  [[nodiscard]] double FeltSigned(double truth) const noexcept {
    return std::copysign(Felt(std::abs(truth)), truth);
  }

  [[nodiscard]] double TrueSigned(double felt) const noexcept {
    return std::copysign(True(std::abs(felt)), felt);
  }

  /** End of the linear part [N or N m]. */
  [[nodiscard]] double linear_limit() const noexcept { return linear_limit_; }

 private:
  double linear_limit_{0};
};

/** The largest true magnitudes of interest: a press of 100 kN; as a torque, at 50 mm. */
inline constexpr double kLargestTrueForce = 100e3;  // [N]
inline constexpr double kLargestTrueTorque = 5e3;   // [N m]

/** They are felt as this share of the device's force and torque. The coupling can pull a little
 harder (HapticTick), so that the hand moves whatever the map shows. */
inline constexpr double kLargestFeltShare = 0.85;

/** The maps of a device: all that they depend on. */
[[nodiscard]] inline ForceMap MakeForceMap(const device::DeviceProfile& device) {
  return {kLargestTrueForce, kLargestFeltShare * device.max_force};
}

[[nodiscard]] inline ForceMap MakeTorqueMap(const device::DeviceProfile& device) {
  return {kLargestTrueTorque, kLargestFeltShare * device.max_torque};
}

}  // namespace hvas::haptics
