#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "spatial/pose.h"

namespace hvas::paths {

/** Numbers at the nodes of a regular grid; node (i, j, k) lies at origin + spacing (i, j, k). */
struct Grid {
  using Index = std::array<int, 3>;

  Vec3 origin{Vec3::Zero()};
  double spacing{0};          ///< [m]
  Index count{0, 0, 0};       ///< Nodes along each axis.
  std::vector<float> values;  ///< x runs fastest.
  /** None, or of each node outside a surface the direction away from the nearest point of it, in
   units of kNormalUnit; zero where that is not known. */
  std::vector<std::array<std::int16_t, 3>> normals;

  static constexpr double kNormalUnit = 1.0 / 32767;  ///< 16 bits with a sign.

  [[nodiscard]] std::size_t IndexOf(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(count[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(k));
  }

  [[nodiscard]] Vec3 PositionOf(int i, int j, int k) const {
    return origin + spacing * Vec3(i, j, k);
  }
};

/** Nodes `low` and up to, not with, `high`. */
struct NodeRange {
  Grid::Index low{0, 0, 0};
  Grid::Index high{0, 0, 0};

  [[nodiscard]] int longest() const;
  [[nodiscard]] Vec3 CalcCentre(const Grid& grid) const;
  /** The distance from the centre to the furthest node [m]. */
  [[nodiscard]] double CalcRadius(const Grid& grid) const;
  /** Divides the block into halves along every axis that has more than one node. */
  [[nodiscard]] std::vector<NodeRange> Split() const;
};

/** Calls visit(index of the node, its position) for each node of a range. */
template <typename Visit>
void ForEachNode(const Grid& grid, const NodeRange& range, const Visit& visit) {
  for (int k = range.low[2]; k < range.high[2]; ++k) {
    for (int j = range.low[1]; j < range.high[1]; ++j) {
      for (int i = range.low[0]; i < range.high[0]; ++i) {
        visit(grid.IndexOf(i, j, k), grid.PositionOf(i, j, k));
      }
    }
  }
}

/** A grid over low .. high [m], without values yet. */
[[nodiscard]] Grid MakeGrid(const Vec3& low, const Vec3& high, double spacing);

}  // namespace hvas::paths
