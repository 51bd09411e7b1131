#include "paths/surface.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace hvas::paths {
namespace {

/** A corner of a cell: bit 0 is along x, bit 1 along y, bit 2 along z. */
using Corner = unsigned;

/** Corners so that the last three turn anticlockwise, seen from the first one. */
using Tetrahedron = std::array<Corner, 4>;

// From corner 0 to corner 7 along the axes, in each order of them; odd orders have their last two
// corners swapped.
constexpr std::array<Tetrahedron, 6> kTetrahedra{
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 1, 7, 5}, {0, 2, 7, 3}, {0, 4, 7, 6}}};

class Extraction {
 public:
  explicit Extraction(const Grid& grid) : grid_(grid) {}

  SurfaceMesh Run() {
    for (int k = 0; k + 1 < grid_.count[2]; ++k) {
      for (int j = 0; j + 1 < grid_.count[1]; ++j) {
        for (int i = 0; i + 1 < grid_.count[0]; ++i) {
          AddCell({i, j, k});
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  void AddCell(const Grid::Index& cell) {
    unsigned inside = 0;
    for (Corner corner = 0; corner < 8; ++corner) {
      value_[corner] = static_cast<double>(grid_.values[NodeOf(cell, corner)]);
      inside |= value_[corner] < 0 ? 1U << corner : 0U;
    }
    if (inside == 0 || inside == 0xffU) {
      return;
    }
    for (const Tetrahedron& tetrahedron : kTetrahedra) {
      AddTetrahedron(cell, tetrahedron);
    }
  }

  void AddTetrahedron(const Grid::Index& cell, Tetrahedron corners) {
    const auto is_inside = [this](Corner corner) { return value_[corner] < 0; };
    const auto count = std::count_if(corners.begin(), corners.end(), is_inside);
    if (count == 0 || count == 4) {
      return;
    }
    // The corner that is alone comes first, or the two that are inside, by an even permutation.
    const bool first_side = count != 3;
    std::size_t ahead = 0;
    bool is_odd = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (is_inside(corners[i]) == first_side) {
        is_odd = is_odd != (i != ahead);
        std::swap(corners[i], corners[ahead]);
        ++ahead;
      }
    }
    if (is_odd) {
      std::swap(corners[2], corners[3]);
    }
    const auto at = [&](std::size_t a, std::size_t b) {
      return VertexOn(cell, corners[a], corners[b]);
    };
    if (count == 1) {
      mesh_.triangles.push_back({at(0, 1), at(0, 2), at(0, 3)});
    } else if (count == 3) {
      mesh_.triangles.push_back({at(0, 1), at(0, 3), at(0, 2)});
    } else {
      mesh_.triangles.push_back({at(0, 2), at(0, 3), at(1, 3)});
      mesh_.triangles.push_back({at(0, 2), at(1, 3), at(1, 2)});
    }
  }

  /** Where the value is zero on an edge, the same vertex for all cells around it. */
  std::uint32_t VertexOn(const Grid::Index& cell, Corner a, Corner b) {
    const Corner low = a & b;
    const Corner high = a | b;  // along an edge no axis goes back
    const std::uint64_t key = 8 * static_cast<std::uint64_t>(NodeOf(cell, low)) + (high ^ low);
    const auto [entry, is_new] =
        vertex_of_edge_.emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      constexpr double kLeast = 1e-3;  // of the edge: triangles keep an area
      const double t = std::clamp(FindCut(cell, low, high), kLeast, 1 - kLeast);
      mesh_.vertices.push_back((1 - t) * PositionOf(cell, low) + t * PositionOf(cell, high));
    }
    return entry->second;
  }

  /** Where on an edge, from low (0) to high (1). */
  [[nodiscard]] double FindCut(const Grid::Index& cell, Corner low, Corner high) const {
    const bool is_high_outside = value_[low] < 0;
    const Corner outside = is_high_outside ? high : low;
    if (!grid_.normals.empty()) {
      const auto& n = grid_.normals[NodeOf(cell, outside)];
      const Vec3 normal = Grid::kNormalUnit * Vec3(n[0], n[1], n[2]);
      const Vec3 way = PositionOf(cell, is_high_outside ? low : high) - PositionOf(cell, outside);
      const double approach = -normal.dot(way);
      if (approach > value_[outside]) {
        const double part = value_[outside] / approach;
        return is_high_outside ? 1 - part : part;
      }
    }
    return value_[low] / (value_[low] - value_[high]);
  }

  [[nodiscard]] std::size_t NodeOf(const Grid::Index& cell, Corner corner) const {
    return grid_.IndexOf(cell[0] + static_cast<int>(corner & 1U),
                         cell[1] + static_cast<int>(corner >> 1U & 1U),
                         cell[2] + static_cast<int>(corner >> 2U));
  }

  [[nodiscard]] Vec3 PositionOf(const Grid::Index& cell, Corner corner) const {
    return grid_.PositionOf(cell[0] + static_cast<int>(corner & 1U),
                            cell[1] + static_cast<int>(corner >> 1U & 1U),
                            cell[2] + static_cast<int>(corner >> 2U));
  }

  const Grid& grid_;
  std::array<double, 8> value_{};  // At the corners of the cell at hand.
  SurfaceMesh mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_edge_;
};

}  // namespace

SurfaceMesh ExtractSurface(const Grid& grid) {
  return Extraction(grid).Run();
}

double CalcVolume(const SurfaceMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return six / 6;
}

}  // namespace hvas::paths
