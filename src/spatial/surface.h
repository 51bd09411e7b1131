#pragma once

#include "spatial/pose.h"

namespace hvas::spatial {

enum class SurfaceKind { kPlane, kCylinder, kCone, kSphere, kTorus, kFreeform };

/** The unbounded analytic surface under a CAD face, oriented by the solid.

 | kind | origin | axis | radius | second |
 |---|---|---|---|---|
 | plane | a point | outward normal | - | - |
 | cylinder | a point of the axis | axis | radius | - |
 | cone | apex | axis, into the nappe that is used | - | half angle [rad] |
 | sphere | centre | - | radius | - |
 | torus | centre | axis | major radius | minor radius |

 `outward` is +1 where the material lies on the inner side of the surface (a shaft, a ball) and -1
 where it lies outside (a hole). For a plane it is +1 and the axis points out of the material. */
struct Surface {
  SurfaceKind kind{SurfaceKind::kFreeform};
  Vec3 origin{Vec3::Zero()};
  Vec3 axis{Vec3::UnitZ()};
  double radius{0};
  double second{0};
  double outward{1};
};

/** Signed distance to a surface and its gradient (unit, out of the material). */
struct SurfaceDistance {
  double distance{0};  ///< [m], positive outside the material.
  Vec3 gradient{Vec3::Zero()};
  bool is_valid{false};  ///< False for freeform surfaces and on an axis: no gradient.
};

/** Exact distance from a point to an analytic surface, in the surface's frame. RT-safe. */
[[nodiscard]] SurfaceDistance CalcDistance(const Surface& surface, const Vec3& p) noexcept;

/** Does so for a cone whose half angle's cosine and sine are known. RT-safe. */
[[nodiscard]] SurfaceDistance CalcConeDistance(const Surface& cone, double cosine, double sine,
                                               const Vec3& p) noexcept;

/** Gives a surface in another frame: A's coordinates of what is given in B. */
[[nodiscard]] Surface Transform(const Pose& X_AB, const Surface& surface_B);

}  // namespace hvas::spatial
