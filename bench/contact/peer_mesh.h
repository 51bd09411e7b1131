#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "contact/shape.h"

namespace hvas::bench {

/** A welded closed mesh as methods on triangles get it, in millimetres, as they are used to. */
struct PeerMesh {
  std::vector<Vec3> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face;  ///< CAD face that each triangle belongs to.
  std::size_t face_count{0};
};

/** Welds a mesh and halves its longest edges, the triangles on both sides with them, until it has
 `at_least` triangles: conforming, and the same surface. */
[[nodiscard]] PeerMesh MakePeerMesh(const contact::ShapeSource& source, std::size_t at_least);

/** The mesh of a part by its number. */
using MeshOf = std::function<const PeerMesh&(std::size_t)>;

}  // namespace hvas::bench
