#include "haptics/coupling_rule.h"

#include <algorithm>

namespace hvas::haptics {
namespace {

constexpr double kShare = 0.5;  // of what a maker allows
/** Of the most relaxed grip that still holds a stylus; a firm one has ten times as much. */
constexpr double kGripDamping = 5;         // [N s/m]
constexpr double kGripTurnDamping = 0.02;  // [N m s/rad]

/** One kind of motion of a device. SI. */
struct Axis {
  double max_stiffness;
  double max_damping;
  double friction;  // Coulomb's
  double resolution;
  double damping;  // of mechanism and hand
};

struct Gains {
  double k;
  double b;
};

Gains Choose(const Axis& axis, double period, double delay) {
  const double late = 0.5 * period + delay;  // Sampled and held, and late.
  Gains gains{};
  gains.k = std::min(kShare * axis.max_stiffness, kShare * axis.damping / late);
  if (axis.resolution > 0 && axis.friction > 0) {
    gains.k = std::min(gains.k, 2 * axis.friction / axis.resolution);
  }
  gains.b = std::min(kShare * axis.max_damping, axis.damping - gains.k * late);
  return gains;
}

}  // namespace

CouplingGains ChooseCoupling(const device::DeviceProfile& profile, double scale,
                             double dt) noexcept {
  CouplingGains gains;
  const double period = profile.rate_hz > 0 ? std::max(dt, 1 / profile.rate_hz) : dt;
  if (profile.max_force > 0 && profile.max_stiffness > 0) {
    const Gains lin = Choose({profile.max_stiffness, profile.max_damping, profile.friction,
                              profile.position_resolution, profile.damping + kGripDamping},
                             period, profile.delay);
    gains.k_lin = lin.k / scale;
    gains.b_lin = lin.b / scale;
  }
  if (profile.max_torque > 0 && profile.max_rotational_stiffness > 0) {
    const Gains rot = Choose({profile.max_rotational_stiffness, profile.max_rotational_damping,
                              profile.rotational_friction, profile.rotation_resolution,
                              profile.rotational_damping + kGripTurnDamping},
                             period, profile.delay);
    gains.k_rot = rot.k;
    gains.b_rot = rot.b;
  }
  return gains;
}

}  // namespace hvas::haptics
