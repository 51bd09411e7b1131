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
    case SurfaceKind::kCone: {
      const double r = radial.norm();
      if (r < kOnAxis) {
        return {};
      }
      const double c = std::cos(surface.second);
      const double s = std::sin(surface.second);
      return {surface.outward * (r * c - height * s),
              surface.outward * (c / r * radial - s * surface.axis), true};
    }
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

Surface Transform(const Pose& X_AB, const Surface& surface_B) {
  Surface surface_A = surface_B;
  surface_A.origin = X_AB * surface_B.origin;
  surface_A.axis = X_AB.q() * surface_B.axis;
  return surface_A;
}

}  // namespace hvas::spatial
