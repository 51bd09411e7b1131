#pragma once

#include <cstdint>
#include <vector>

#include "product/product.h"

namespace hvas::product::testing {

/** Adds a flat face to a part, as a fan of triangles. @param corners  Corners in the order seen
 from outside of the material. */
inline void AddFlatFace(const std::vector<Vec3>& corners, Part* part) {
  Face face;
  face.surface.kind = SurfaceKind::kPlane;
  face.surface.origin = corners[0];
  face.surface.axis = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
  face.triangle_count = static_cast<std::uint32_t>(corners.size()) - 2;
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  for (const Vec3& corner : corners) {
    part->mesh.vertices.push_back(corner);
    face.box_B.Add(corner);
    part->box_B.Add(corner);
  }
  for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) {
    part->mesh.triangles.push_back({first, first + i, first + i + 1});
    face.area += 0.5 * (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]).norm();
  }
  part->faces.push_back(face);
}

}  // namespace hvas::product::testing
