#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "contact/mesh.h"
#include "spatial/surface.h"

/** Where threads may be in a mesh: the axes they may be about, and the pitch that most normals tell
 of each. Used by FindHelices() alone. */
namespace hvas::contact {

/** A line that a thread may be about. */
struct ThreadAxis {
  Vec3 origin{Vec3::Zero()};
  Vec3 direction{Vec3::UnitZ()};  ///< Unit.
  double area{0};                 ///< Area of the faces of revolution about it [m^2].
};

/** A vertex of a mesh with the mean of normals around it. What each of these triangles is wrong by,
 as it is flat, cancels out. */
struct SurfacePoint {
  Vec3 p{Vec3::Zero()};
  Vec3 n{Vec3::Zero()};     ///< Normal out of the material, as long as the area around the point.
  double area{0};           ///< [m^2]
  bool is_freeform{false};  ///< A freeform face is there.
};

/** Lists the points of a mesh: one for each vertex and each direction in which triangles around it
 look, as there are several at an edge.
 @param faces  Surface of each face of the mesh. */
[[nodiscard]] std::vector<SurfacePoint> ListSurfacePoints(
    const Mesh& mesh, const std::vector<spatial::Surface>& faces);

/** Lists the axes that threads may be about: those of the faces of revolution, the eight with the
 most area, and that of the screw motion which moves most of the freeform faces along themselves. */
[[nodiscard]] std::vector<ThreadAxis> ListThreadAxes(const Mesh& mesh,
                                                     const std::vector<spatial::Surface>& faces,
                                                     const std::vector<SurfacePoint>& points);

/** Calculates the pitch that a thread about an axis has if the point is on one, with the sign of
 its sense [m]; 0 where the point tells none. */
[[nodiscard]] double CalcThreadPitch(const SurfacePoint& point, const ThreadAxis& axis);

/** Finds the pitch around which the most area is [m], and that area [m^2]. */
[[nodiscard]] std::pair<double, double> FindThreadPitch(const std::vector<SurfacePoint>& points,
                                                        const ThreadAxis& axis);

/** So many of some elements, evenly, or all where there are no more. */
template <typename T>
[[nodiscard]] std::vector<T> Thinned(const std::vector<T>& all, std::size_t most) {
  if (all.size() <= most) {
    return all;
  }
  std::vector<T> kept;
  for (std::size_t i = 0; i < most; ++i) {
    kept.push_back(all[i * all.size() / most]);
  }
  return kept;
}

}  // namespace hvas::contact
