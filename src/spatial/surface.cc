#include "spatial/surface.h"

#include <cmath>

namespace hvas::spatial {
namespace {

constexpr double kOnAxis = 1e-12;  // [m]; closer than this there is no radial direction.

SurfaceDistance RadialDistance(const Vec3& q, double radius, double outward) noexcept {
  const double r = q.norm();
  if (r < kOnAxis) {
    return {};
  }
  return {outward * (r - radius), outward / r * q, true};
}

}  // namespace

SurfaceDistance CalcDistance(const Surface& surface, const Vec3& p) noexcept {
  const Vec3 q = p - surface.origin;
  const double height = q.dot(surface.axis);
  const Vec3 radial = q - height * surface.axis;
  switch (surface.kind) {
    case SurfaceKind::kPlane:
      return {surface.outward * height, surface.outward * surface.axis, true};
    case SurfaceKind::kCylinder:
      return RadialDistance(radial, surface.radius, surface.outward);
    case SurfaceKind::kSphere:
      return RadialDistance(q, surface.radius, surface.outward);
    case SurfaceKind::kCone:
      return CalcConeDistance(surface, std::cos(surface.second), std::sin(surface.second), p);
    case SurfaceKind::kTorus: {
      const double r = radial.norm();
      if (r < kOnAxis) {
        return {};
      }
      return RadialDistance(q - surface.radius / r * radial, surface.second, surface.outward);
    }
    case SurfaceKind::kFreeform:
      break;
  }
  return {};
}

SurfaceDistance CalcConeDistance(const Surface& cone, double cosine, double sine,
                                 const Vec3& p) noexcept {
  const Vec3 q = p - cone.origin;
  const double height = q.dot(cone.axis);
  const Vec3 radial = q - height * cone.axis;
  const double r = radial.norm();
  if (r < kOnAxis) {
    return {};
  }
  return {cone.outward * (r * cosine - height * sine),
          cone.outward * (cosine / r * radial - sine * cone.axis), true};
}

Surface Transform(const Pose& X_AB, const Surface& surface_B) {
  Surface surface_A = surface_B;
  surface_A.origin = X_AB * surface_B.origin;
  surface_A.axis = X_AB.q() * surface_B.axis;
  return surface_A;
}

}  // namespace hvas::spatial
