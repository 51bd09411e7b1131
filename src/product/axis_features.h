#pragma once

#include <vector>

#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** The one of a line's two directions whose largest component is positive. */
[[nodiscard]] Vec3 Canonical(const Vec3& axis);

/** Within 1 mrad, either way round. */
[[nodiscard]] bool IsParallel(const Vec3& a, const Vec3& b);

[[nodiscard]] double DistanceToAxis(const Vec3& p, const Vec3& origin, const Vec3& axis);

/** Holes and shafts: cylindrical faces of one axis, radius and sense whose axial spans touch, where
 they hold a pin of their size against leaving sideways: together they cover at least 200 deg of the
 turn, or, at one station along the axis, no gap between them is above 160 deg. Of the latter those
 are left out that a narrower bore, or a thicker shaft, of the same axis stands before (the bottoms
 of splines). By their first face.
 @param tolerance Of radii and positions [m]. @param limits Gets the limits that were reached.
 @param partial Gets those that hold nothing by themselves: cylinders that only the ends of teeth
 lie on (splines, gears, knurls), then the round ends of slots and tongues. */
[[nodiscard]] std::vector<Feature> FindCylinders(const Part& part, double tolerance,
                                                 RecognitionLimits* limits,
                                                 std::vector<Feature>* partial);

/** Whether a hole or shaft consists of the ends of teeth alone: twelve or more short arcs, which
 leave gaps. */
[[nodiscard]] bool IsToothed(const Feature& feature);

/** Whether a cylinder covers half a turn: the round end of a slot, or of what lies in one, as a
 parallel key of form A in its seat (DIN 6885). */
[[nodiscard]] bool IsRoundEnd(const Feature& feature);

/** The mean of the unit vectors from the axis of a cylinder to its faces, in B: the middle of the
 arc; 2/pi long for half a turn, zero for a whole one. */
[[nodiscard]] Vec3 CalcArcDirection(const Part& part, const Feature& feature);

/** Conical seats and tapers by the same rule: conical faces of one axis, apex, half angle and
 sense. */
[[nodiscard]] std::vector<Feature> FindCones(const Part& part, double tolerance,
                                             RecognitionLimits* limits);

}  // namespace hvas::product
