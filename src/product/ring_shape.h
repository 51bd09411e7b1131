#pragma once

#include <optional>

#include "product/product.h"

namespace hvas::product {

/** A plain flat ring: a body of one section that goes round an axis, closed or split. */
struct RingShape {
  Vec3 axis_B{Vec3::UnitZ()};   ///< Unit.
  Vec3 centre_B{Vec3::Zero()};  ///< Point of the axis, in the middle of its height [m].
  double inner{0};              ///< Radii [m].
  double outer{0};
  double height{0};  ///< Along its axis [m].
  double gap{0};     ///< Angle that it leaves open, at half of its height [rad]; 0: it is closed.

  [[nodiscard]] double width() const { return outer - inner; }

  [[nodiscard]] double mean_radius() const { return 0.5 * (inner + outer); }
};

/** Measures the mesh of a part as a ring: lower than it is wide, with one section all around, which
 fills its rectangle by two thirds or more. None where the part is something else. */
[[nodiscard]] std::optional<RingShape> FindRingShape(const Part& part);

/** Angle about an axis in which a plane across it, at a height above the centre, meets nothing of a
 part: the largest one [rad]; a full turn where it meets nothing at all.
 @param axis_B  Unit. */
[[nodiscard]] double CalcOpenAngle(const Part& part, const Vec3& centre_B, const Vec3& axis_B,
                                   double height);

/** Strain of an open ring of constant section that is opened or closed and stays round: half of its
 width times the change of its curvature.
 @param growth  Of its mean radius [m]; negative where it is closed. */
[[nodiscard]] double CalcOpeningStrain(const RingShape& ring, double growth);

}  // namespace hvas::product
