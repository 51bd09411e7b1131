#pragma once

#include "spatial/pose.h"

namespace hvas::device {

/** How a stick is pushed: per axis -1 .. 1, both vectors' norms at most 1 count. */
struct Deflection {
  Vec3 move{Vec3::Zero()};
  Vec3 turn{Vec3::Zero()};
};

/** A pose by rate control: deflections are speeds. Small ones do nothing (dead zone), middling ones
 little, so that one can be exact, large ones much: speed = (0.3 u + 0.7 u^3) of the largest, where
 u grows from 0 at the dead zone's edge to 1. The direction stays. RT-safe. */
class RateControl {
 public:
  /** Share of a stick's way in which it is at rest: a choice. */
  static constexpr double kDeadZone = 0.08;
  static constexpr double kMaxSpeed = 0.25;    ///< [m/s]
  static constexpr double kMaxTurnRate = 1.5;  ///< [rad/s]

  /** @param workspace  Edges of the box round D's origin that the pose stays in [m]. */
  explicit RateControl(const Vec3& workspace) : half_(0.5 * workspace) {}

  /** Moves the pose on by a deflection that lasts for dt [s]. */
  void Step(const Deflection& deflection, double dt) noexcept;

  [[nodiscard]] const spatial::Pose& X_DH() const noexcept { return X_DH_; }

  /** During the last step. */
  [[nodiscard]] const spatial::Twist& V_DH() const noexcept { return V_DH_; }

  /** Share of the largest speed for a deflection of some norm. */
  [[nodiscard]] static double Response(double norm) noexcept;

 private:
  Vec3 half_;
  spatial::Pose X_DH_;
  spatial::Twist V_DH_;
};

}  // namespace hvas::device
