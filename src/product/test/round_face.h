#pragma once

#include <cmath>
#include <cstdint>

#include "product/product.h"

namespace hvas::product::testing {

/** Appends a face whose triangles start at the part's last triangle so far. */
inline Face& StartFace(Part* part, const Surface& surface) {
  Face face;
  face.surface = surface;
  face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
  part->faces.push_back(face);
  return part->faces.back();
}

inline void AddQuad(Part* part, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Face& face = part->faces.back();
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  for (const Vec3& p : {a, b, c, d}) {
    part->mesh.vertices.push_back(p);
    face.box_B.Add(p);
    part->box_B.Add(p);
  }
  part->mesh.triangles.push_back({first, first + 1, first + 2});
  part->mesh.triangles.push_back({first, first + 2, first + 3});
  face.triangle_count += 2;
  face.area += 0.5 * ((b - a).cross(c - a).norm() + (c - a).cross(d - a).norm());
}

/** A cylindrical face about the axis through (x, 0, 0) along z, from angle `from` on. */
inline void AddRoundFace(Part* part, double x, double radius, double outward, double from,
                         double sweep, double low, double high) {
  Surface surface;
  surface.kind = SurfaceKind::kCylinder;
  surface.origin = {x, 0, 0.123};
  surface.axis = part->faces.size() % 2 == 0 ? Vec3(0, 0, 1) : Vec3(0, 0, -1);
  surface.radius = radius;
  surface.outward = outward;
  StartFace(part, surface);
  constexpr int kSteps = 24;
  for (int i = 0; i < kSteps; ++i) {
    const double a = from + sweep * i / kSteps;
    const double b = from + sweep * (i + 1) / kSteps;
    const Vec3 pa(x + radius * std::cos(a), radius * std::sin(a), 0);
    const Vec3 pb(x + radius * std::cos(b), radius * std::sin(b), 0);
    AddQuad(part, pa + Vec3(0, 0, low), pb + Vec3(0, 0, low), pb + Vec3(0, 0, high),
            pa + Vec3(0, 0, high));
  }
}

}  // namespace hvas::product::testing
