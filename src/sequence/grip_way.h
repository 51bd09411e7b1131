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
  /** Share of the travel: where less of it is distance, the way turns. A choice. */
  static constexpr double kTurningShare = 0.2;

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

  /** The travel of the pose on the way that is nearest to this one, looked for from `near` on, from
   piece to piece for as long as it comes nearer. */
  [[nodiscard]] double CalcTravel(const spatial::Pose& X_WG, double near) const noexcept;

  /** The largest change of direction within a stretch of the way: the length of the difference of
   two rates, 0 where it goes straight on and 2 where it turns back.
   @param along  Of either sign [m]. */
  [[nodiscard]] double CalcSharpestBend(double travel, double along) const noexcept;

  /** Rate of travel at this motion [m/s]. @param travel  Where on the way. */
  [[nodiscard]] double CalcSpeed(const spatial::Twist& V_W, double travel) const noexcept;

 private:
  struct Nearest {
    double travel{0};
    double distance{0};  ///< Root of the squares of distance and of turn times the radius [m].
  };

  /** The nearest pose of one piece, of which the first and the last have no end outside. */
  [[nodiscard]] Nearest FindNearest(const spatial::Pose& X_WG, std::size_t piece,
                                    double from) const noexcept;

  /** The piece on which a travel lies. */
  [[nodiscard]] std::size_t FindPiece(double travel) const noexcept;

  std::vector<spatial::Pose> X_WG_;
  std::vector<double> travels_;
  double radius_;
  Vec3 outward_W_{Vec3::UnitZ()};
};

}  // namespace hvas::sequence
