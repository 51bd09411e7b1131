#pragma once

#include <cstdint>

#include "spatial/pose.h"

namespace hvas::simulation {

/** The greatest force with which a hand presses, pulls or carries [N]; the rest is for a press, a
 mallet or a hoist. A choice. */
inline constexpr double kMostHandForce = 100;

/** Impedance of an arm at the hand: mass, spring and damper between the hand and where it is meant
 to be. The defaults are of the order published for hands that hold a haptic device or keep a
 posture (docs/algorithms/simulated_person.md). */
struct Arm {
  double mass{0.8};          ///< Effective mass at the hand [kg].
  double stiffness{400};     ///< [N/m]
  double damping{25};        ///< [N s/m]
  double inertia{3e-3};      ///< Inertia of the hand's turning [kg m^2].
  double turn_stiffness{6};  ///< [N m/rad]
  double turn_damping{0.2};  ///< [N m s/rad]
};

/** Where a person wants the hand to be, and what else it does; the hand is drawn there by the arm's
 impedance. */
struct HandReference {
  spatial::Pose X_WR;
  Vec3 v_R_W{Vec3::Zero()};  ///< [m/s]
  Vec3 f_W{Vec3::Zero()};    ///< Besides, to hold up what it carries [N].
  bool is_gripping{false};
  std::int64_t client_age_ns{0};  ///< Grip, as in device::DeviceState.
};

/** Moves a hand by one sample: mass, spring and damper of the arm draw it to the reference, against
 the wrench of the device. RT-safe.
 @param F_H_W  Wrench of the device on the hand.
 @param X_WH,V_WH  Pose and twist of the hand, which are moved on by dt [s]. */
void AdvanceArm(const Arm& arm, const HandReference& reference, const spatial::Wrench& F_H_W,
                double dt, spatial::Pose* X_WH, spatial::Twist* V_WH) noexcept;

}  // namespace hvas::simulation
