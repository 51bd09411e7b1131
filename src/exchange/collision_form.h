#pragma once

#include <map>
#include <vector>

#include "product/product.h"

namespace hvas::exchange {

/** A cylinder about the z axis of a frame C, from -half_length to half_length [m]. */
struct Cylinder {
  spatial::Pose X_BC;
  double radius{0};
  double half_length{0};
};

/** A part as convex bodies, for programs that have no contact of concave ones. Lengths in m, in the
 part's frame B. */
struct CollisionForm {
  std::vector<std::vector<Vec3>> pieces;  ///< Each is the hull of its points.
  std::vector<Cylinder> cylinders;
  /** Nothing but the hull of the whole part: it would have taken too many pieces. Holes are closed
   in it. */
  bool is_hull_only{false};
};

/** Radii that cylindrical features are to have instead of the drawn ones [m]. */
using FeatureRadii = std::map<std::size_t, double>;

/** Makes convex bodies of a part.

 A convex part is one piece. Of another one, plane faces are divided into convex polygons, other
 faces into the triangles of the display mesh; each is a frustum that goes a little into the part
 and becomes narrower, so that it does not come out of the faces beside it. A full shaft is a
 cylinder; a full hole has flat walls that touch it from outside, so that a shaft in it has the true
 clearance in all directions of `kWalls`. Both have their radius in `radii`, else the drawn one, and
 vertices on features with a radius there are moved to it. */
[[nodiscard]] CollisionForm MakeCollisionForm(const product::Part& part, const FeatureRadii& radii);

/** Flat walls around a hole: between two of them the clearance is larger by r (1 / cos(pi / n) -
 1), 0.2 % of the radius. A choice. */
inline constexpr int kWalls = 48;

}  // namespace hvas::exchange
