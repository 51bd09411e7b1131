#pragma once

#include "contact/shape.h"
#include "planning/test/pairs.h"

namespace hvas::simulation::testing {

/** The solid with the triangles of each face together, as parts have them. */
inline contact::ShapeSource MakeSource(const planning::testing::CellSolid& solid) {
  const contact::ShapeSource made = solid.Make();
  contact::ShapeSource sorted = made;
  sorted.triangles.clear();
  sorted.triangle_face.clear();
  for (std::uint32_t face = 0; face < made.faces.size(); ++face) {
    for (std::size_t t = 0; t < made.triangles.size(); ++t) {
      if (made.triangle_face[t] == face) {
        sorted.triangles.push_back(made.triangles[t]);
        sorted.triangle_face.push_back(face);
      }
    }
  }
  return sorted;
}

}  // namespace hvas::simulation::testing
