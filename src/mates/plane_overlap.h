#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "base/work_watch.h"

namespace hvas::mates {

using Vec2 = Eigen::Vector2d;
using Triangle2 = std::array<Vec2, 3>;

/** Area that two sets of plane triangles have in common, and its centroid. */
struct Overlap {
  double area{0};               ///< [m^2]
  Vec2 centroid{Vec2::Zero()};  ///< [m]; zero where the area is zero.
};

/** Exact up to rounding, when the triangles within each set do not overlap each other. Either
 orientation. Sweeps over x, so its cost goes with the number of triangle pairs that meet; what it
 gives when the watch ends it is of no use. */
[[nodiscard]] Overlap CalcOverlap(const std::vector<Triangle2>& a, const std::vector<Triangle2>& b,
                                  WorkWatch* watch = nullptr);

/** Those of `triangles` whose boxes meet the box of all of `others`. */
[[nodiscard]] std::vector<Triangle2> SelectNear(const std::vector<Triangle2>& triangles,
                                                const std::vector<Triangle2>& others);

}  // namespace hvas::mates
