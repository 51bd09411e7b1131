#pragma once

#include <span>
#include <vector>

#include "spatial/pose.h"

namespace hvas::dynamics {

/** Picks at most `count` of the given points (count >= 26) that span nearly the same convex hull:
 the outermost ones in 26 directions, then each time the one farthest from all chosen. Order decided
 by the input alone. */
[[nodiscard]] std::vector<Vec3> SelectSpread(std::span<const Vec3> points, std::size_t count);

}  // namespace hvas::dynamics
