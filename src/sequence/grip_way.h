#pragma once

#include <vector>

#include "spatial/pose.h"

namespace hvas::sequence {

/** The way of a grip from its goal outward: along given poses, evenly from one to the next, and
 from the last one on straight. Its parameter is the travel: 0 at the goal; from pose to pose it
 grows by the root of the sum of squares of the distance and of the turn times a radius. RT-safe but
 for the constructor. */
class GripWay {
 public:
  /** @param X_WG  The goal first; two poses at least, of which the last two differ in position.
   @param radius  By which turns count as lengths: that of gyration of what is held [m]. */
  GripWay(std::vector<spatial::Pose> X_WG, double radius);

  /** Travel of the last pose [m]. */
  [[nodiscard]] double length() const { return travels_.back(); }

  /** Unit; the way goes on along it after the last pose. */
  [[nodiscard]] const Vec3& outward_W() const { return outward_W_; }

  [[nodiscard]] spatial::Pose At(double travel) const noexcept;

  /** Change of the pose with the travel there: w [rad/m] and v [1], outward; in W, about the grip.
   */
  [[nodiscard]] spatial::Twist RateAt(double travel) const noexcept;

  /** The travel of the pose on the way that is nearest to this one, looked for from `near` on. */
  [[nodiscard]] double CalcTravel(const spatial::Pose& X_WG, double near) const noexcept;

  /** Rate of travel at this motion [m/s]. @param travel  Where on the way. */
  [[nodiscard]] double CalcSpeed(const spatial::Twist& V_W, double travel) const noexcept;

 private:
  /** The piece on which a travel lies. */
  [[nodiscard]] std::size_t FindPiece(double travel) const noexcept;

  std::vector<spatial::Pose> X_WG_;
  std::vector<double> travels_;
  double radius_;
  Vec3 outward_W_{Vec3::UnitZ()};
};

}  // namespace hvas::sequence
