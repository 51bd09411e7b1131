#include "paths/grid.h"

#include <algorithm>
#include <cmath>

namespace hvas::paths {

int NodeRange::longest() const {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

Vec3 NodeRange::CalcCentre(const Grid& grid) const {
  const Vec3 first = grid.PositionOf(low[0], low[1], low[2]);
  const Vec3 last = grid.PositionOf(high[0] - 1, high[1] - 1, high[2] - 1);
  return 0.5 * (first + last);
}

double NodeRange::CalcRadius(const Grid& grid) const {
  const Vec3 size(high[0] - low[0] - 1, high[1] - low[1] - 1, high[2] - low[2] - 1);
  return 0.5 * grid.spacing * size.norm();
}

std::vector<NodeRange> NodeRange::Split() const {
  std::vector<NodeRange> parts{*this};
  for (std::size_t axis = 0; axis < low.size(); ++axis) {
    const std::size_t count = parts.size();
    for (std::size_t i = 0; i < count; ++i) {
      const int middle = (parts[i].low[axis] + parts[i].high[axis]) / 2;
      if (middle > parts[i].low[axis]) {
        NodeRange upper = parts[i];
        upper.low[axis] = middle;
        parts[i].high[axis] = middle;
        parts.push_back(upper);
      }
    }
  }
  return parts;
}

Grid MakeGrid(const Vec3& low, const Vec3& high, double spacing) {
  Grid grid;
  grid.origin = low;
  grid.spacing = spacing;
  for (int axis = 0; axis < 3; ++axis) {
    grid.count[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::ceil((high[axis] - low[axis]) / spacing)) + 1;
  }
  return grid;
}

}  // namespace hvas::paths
