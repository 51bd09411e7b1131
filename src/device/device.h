#pragma once

#include <cstdint>
#include <string>

#include "spatial/pose.h"

namespace hvas::device {

/** What a device can do and show. SI. Values of real devices are read from them at run time. */
struct DeviceProfile {
  std::string name;
  double max_force{7.9};                ///< Peak [N].
  double max_torque{0.4};               ///< Peak [N m]; 0 for three actuated axes.
  double max_stiffness{1000};           ///< [N/m]
  double max_damping{8};                ///< [N s/m]
  double max_rotational_stiffness{3};   ///< [N m/rad]
  double max_rotational_damping{0.02};  ///< [N m s/rad]
};

/** One sample from a device: the hand H in the device's base frame. */
struct DeviceState {
  std::int64_t t_ns{0};
  spatial::Pose X_DH;
  spatial::Twist V_DH;      ///< Of H in D, expressed in D.
  bool is_gripping{false};  ///< The button or grip that holds a part.
  bool is_valid{true};      ///< False where the device has no pose: the wrench decays to zero.
};

}  // namespace hvas::device
