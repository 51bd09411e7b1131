#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "paths/surface.h"

namespace hvas::paths::testing {

/** Whether every edge belongs to two triangles that go along it in opposite directions, and every
 triangle has three corners. */
inline bool IsClosed(const SurfaceMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = t[k];
      const auto b = t[(k + 1) % 3];
      if (a == b || !directed.emplace(a, b).second) {
        return false;
      }
    }
  }
  for (const auto& [a, b] : directed) {
    if (directed.count({b, a}) == 0) {
      return false;
    }
  }
  return true;
}

/** Euler's characteristic: 2 of a ball, 0 of a ring. @pre IsClosed. */
inline std::int64_t CalcEuler(const SurfaceMesh& mesh) {
  const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
  return static_cast<std::int64_t>(mesh.vertices.size()) - 3 * triangles / 2 + triangles;
}

}  // namespace hvas::paths::testing
