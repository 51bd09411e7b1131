#pragma once

#include <array>
#include <string>

#include "base/id.h"
#include "product/ids.h"
#include "spatial/pose.h"

namespace hvas::product {

/** Relations of two parts beside the mates (X2): none of them guides or seats a part. */
enum class RelationKind {
  kParallel,       ///< Directions of planes or axes, in either sense.
  kPerpendicular,  ///< Directions at a right angle.
  kAngle,          ///< Directions at another angle.
  kFlush,          ///< Planes in one plane, normals to the same side.
  kDistance,       ///< Parallel planes, or parallel axes, at a distance.
  kTangent,        ///< A cylinder or sphere touches a plane, cylinder or sphere.
  kEdgeOnEdge,     ///< Straight edges on one line.
  kHoleToHole,     ///< Two holes on one axis, for a pin to come.
};

/** All kinds of relations, in the order of their numbers. */
inline constexpr std::array kRelationKinds{RelationKind::kParallel,   RelationKind::kPerpendicular,
                                           RelationKind::kAngle,      RelationKind::kFlush,
                                           RelationKind::kDistance,   RelationKind::kTangent,
                                           RelationKind::kEdgeOnEdge, RelationKind::kHoleToHole};

/** What a relation holds on to. */
enum class ElementKind {
  kPlane,     ///< Origin in the plane, axis along the outward normal.
  kCylinder,  ///< Origin on the axis, axis along it.
  kSphere,    ///< Origin in the centre.
  kEdge,      ///< Straight edge of two planes: origin in its middle, axis along it.
};

/** One side of a relation, in the frame B of its part. */
struct RelationSide {
  OccurrenceId occurrence;
  FeatureId feature;  ///< The feature; edges: that of the first plane.
  FeatureId second;   ///< Edges: the feature of the second plane; else invalid.
  ElementKind element{ElementKind::kPlane};
  Vec3 origin_B{Vec3::Zero()};
  Vec3 axis_B{Vec3::UnitZ()};
  double radius{0};       ///< Radius of cylinder or sphere [m].
  bool is_inward{false};  ///< True for a hole or a socket, whose material is outside.
};

struct Relation {
  RelationKind kind{RelationKind::kParallel};
  RelationSide a;
  RelationSide b;
  double magnitude{0};       ///< Angle [rad] or distance [m]; 0 for the other kinds.
  bool is_stated{false};     ///< True where the user states it; else it is inferred.
  int free_translations{3};  ///< Directions in which b can still move on a: 0..3.
  int free_rotations{3};     ///< 0..3
  double residual{0};  ///< Length by which the drawn pose misses it, angles times a length [m].
};

}  // namespace hvas::product
