#include "sequence/mate_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace hvas::sequence {
namespace {

/** Whether a face has a vertex on a plane of its part. */
bool ReachesPlane(const product::Part& part, const product::Face& face,
                  const spatial::Surface& plane) {
  constexpr double kAtPlane = 10e-6;  // [m]; drawings that were converted are off by some um.
  const auto is_at_plane = [&](std::uint32_t v) {
    return std::abs(plane.axis.dot(part.mesh.vertices[v] - plane.origin)) < kAtPlane;
  };
  for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
    const std::array<std::uint32_t, 3>& triangle = part.mesh.triangles[face.first_triangle + t];
    if (std::any_of(triangle.begin(), triangle.end(), is_at_plane)) {
      return true;
    }
  }
  return false;
}

}  // namespace

haptics::MateFaces CollectMateFaces(const product::Part& part,
                                    const std::vector<product::FaceId>& mating) {
  // Faces share an edge where two of their vertices coincide; meshes of neighbouring CAD faces meet
  // in the same points.
  using Key = std::array<std::int64_t, 3>;
  const double grid = std::max(1e-9, 1e-7 * part.box_B.size().norm());
  const auto key = [grid](const Vec3& p) {
    return Key{std::llround(p.x() / grid), std::llround(p.y() / grid), std::llround(p.z() / grid)};
  };
  const auto vertices_of = [&](std::size_t f) {
    std::set<Key> keys;
    const product::Face& face = part.faces[f];
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
        keys.insert(key(part.mesh.vertices[v]));
      }
    }
    return keys;
  };
  haptics::MateFaces faces;
  std::set<Key> own;
  for (const product::FaceId id : mating) {
    faces.mating.push_back(id.value());
    own.merge(vertices_of(id.index()));
  }
  std::sort(faces.mating.begin(), faces.mating.end());
  const auto reaches_plane = [&part, &mating](const product::Face& face) {
    return std::any_of(mating.begin(), mating.end(), [&](product::FaceId id) {
      const spatial::Surface& plane = part.faces[id.index()].surface;
      return plane.kind == spatial::SurfaceKind::kPlane && ReachesPlane(part, face, plane);
    });
  };
  faces.with_neighbours = faces.mating;
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    if (std::binary_search(faces.mating.begin(), faces.mating.end(), f)) {
      continue;
    }
    int shared = 0;
    for (const Key& vertex : vertices_of(f)) {
      shared += own.count(vertex) > 0 ? 1 : 0;
    }
    if (shared >= 2 || reaches_plane(part.faces[f])) {
      faces.with_neighbours.push_back(static_cast<std::uint32_t>(f));
    }
  }
  std::sort(faces.with_neighbours.begin(), faces.with_neighbours.end());
  return faces;
}

}  // namespace hvas::sequence
