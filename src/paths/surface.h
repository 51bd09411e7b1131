#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "paths/grid.h"

namespace hvas::paths {

/** A closed triangle mesh, outward; triangles share their vertices. */
struct SurfaceMesh {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/** The surface where values on a grid change their sign; outward is where they are positive. On an
 edge of the grid it is where the plane through the nearest point of the node outside, by the grid's
 normals, cuts it; without them, and where it does not, where the values have it in between.
 Closed and without edges of more than two triangles for any values: by marching
 tetrahedra, six a cell, which fit together (Freudenthal's triangulation).
 Source: Doi and Koide, IEICE Transactions E74(1), 1991.
 @pre the values at the grid's rim are positive. */
[[nodiscard]] SurfaceMesh ExtractSurface(const Grid& grid);

/** The volume, by the divergence theorem [m^3]. */
[[nodiscard]] double CalcVolume(const SurfaceMesh& mesh);

}  // namespace hvas::paths
