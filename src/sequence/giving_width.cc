#include "sequence/giving_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "sequence/face_reliefs.h"
#include "spatial/box.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;
using Triangle = std::array<Vec3, 3>;  // In a frame with z along the way.

constexpr double kCellsPerLimit = 10;     // A choice: the width is good to a fifth of the limit.
constexpr double kMostCellsAcross = 600;  // A choice: 360,000 cells take some milliseconds.

std::vector<Triangle> Project(const product::Product& product, OccurrenceId id, const Mat3& R_FW) {
  const spatial::Pose& X_WB = product.occurrences[id.index()].X_WB;
  const product::Part& part = product.part_of(id);
  const Mat3 R_FB = R_FW * X_WB.R();
  const Vec3 p_F = R_FW * X_WB.p();
  std::vector<Triangle> triangles;
  triangles.reserve(part.mesh.triangles.size());
  for (const auto& [a, b, c] : part.mesh.triangles) {
    triangles.push_back({R_FB * part.mesh.vertices[a] + p_F, R_FB * part.mesh.vertices[b] + p_F,
                         R_FB * part.mesh.vertices[c] + p_F});
  }
  return triangles;
}

spatial::Box BoxOf(const std::vector<Triangle>& triangles) {
  spatial::Box box;
  for (const Triangle& triangle : triangles) {
    for (const Vec3& corner : triangle) {
      box.Add(corner);
    }
  }
  return box;
}

/** A grid across the way. */
struct Grid {
  Vec3 low{Vec3::Zero()};
  double cell{0};  // [m]
  int columns{0};
  int rows{0};

  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }

  [[nodiscard]] std::size_t At(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/** Calls `visit` with each cell whose centre a triangle covers, and the triangle's height there. */
template <typename Visit>
void Rasterise(const Grid& grid, const Triangle& triangle, const Visit& visit) {
  const auto& [a, b, c] = triangle;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (area == 0) {
    return;  // It is seen from its edge.
  }
  const auto column_of = [&grid](double x) { return (x - grid.low.x()) / grid.cell - 0.5; };
  const auto row_of = [&grid](double y) { return (y - grid.low.y()) / grid.cell - 0.5; };
  const auto [x_low, x_high] = std::minmax({a.x(), b.x(), c.x()});
  const auto [y_low, y_high] = std::minmax({a.y(), b.y(), c.y()});
  const auto first = [](double at) { return static_cast<int>(std::ceil(std::max(at, 0.0))); };
  const auto last = [](double at, int count) {
    return static_cast<int>(std::floor(std::min(at, count - 1.0)));
  };
  for (int row = first(row_of(y_low)); row <= last(row_of(y_high), grid.rows); ++row) {
    for (int column = first(column_of(x_low)); column <= last(column_of(x_high), grid.columns);
         ++column) {
      const double x = grid.low.x() + (column + 0.5) * grid.cell - a.x();
      const double y = grid.low.y() + (row + 0.5) * grid.cell - a.y();
      const double u = (x * ac.y() - y * ac.x()) / area;
      const double v = (ab.x() * y - ab.y() * x) / area;
      if (u >= 0 && v >= 0 && u + v <= 1) {
        visit(grid.At(column, row), a.z() + u * ab.z() + v * ac.z());
      }
    }
  }
}

/** The largest distance of a blocked cell from one that is not, in cells: by the weights 3 and 4 of
 a step beside and across (Borgefors, Computer Vision, Graphics, and Image Processing 34, 1986). */
double CalcDeepestCell(const Grid& grid, const std::vector<bool>& is_blocked) {
  constexpr int kBeside = 3;  // Borgefors: the weight of a step beside ...
  constexpr int kAcross = 4;  // ... and of one across.
  std::vector<int> distance(grid.size(), 0);
  const auto at = [&](int column, int row) {
    const bool is_inside = column >= 0 && column < grid.columns && row >= 0 && row < grid.rows;
    return is_inside ? distance[grid.At(column, row)] : 0;
  };
  int deepest = 0;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      if (is_blocked[grid.At(column, row)]) {
        distance[grid.At(column, row)] =
            std::min({at(column - 1, row) + kBeside, at(column, row - 1) + kBeside,
                      at(column - 1, row - 1) + kAcross, at(column + 1, row - 1) + kAcross});
      }
    }
  }
  for (int row = grid.rows - 1; row >= 0; --row) {
    for (int column = grid.columns - 1; column >= 0; --column) {
      int& own = distance[grid.At(column, row)];
      own = std::min({own, at(column + 1, row) + kBeside, at(column, row + 1) + kBeside,
                      at(column + 1, row + 1) + kAcross, at(column - 1, row + 1) + kAcross});
      deepest = std::max(deepest, own);
    }
  }
  return static_cast<double>(deepest) / kBeside;
}

}  // namespace

double CalcGivingWidth(const product::Product& product, OccurrenceId moving, OccurrenceId other,
                       const Vec3& way_W, double limit) {
  const Mat3 R_FW = spatial::FrameFromZ(way_W).toRotationMatrix().transpose();
  const std::vector<Triangle> own = Project(product, moving, R_FW);
  const std::vector<Triangle> others = Project(product, other, R_FW);
  const spatial::Box own_box = BoxOf(own);
  const spatial::Box other_box = BoxOf(others);
  const Vec3 low = own_box.low.cwiseMax(other_box.low);
  const Vec3 extent = own_box.high.cwiseMin(other_box.high) - low;
  const double across = std::max(extent.x(), extent.y());
  if (std::min(extent.x(), extent.y()) <= 0) {
    return 0;
  }
  Grid grid;
  grid.low = low;
  grid.cell = std::max(limit / kCellsPerLimit, across / kMostCellsAcross);
  grid.columns = static_cast<int>(std::ceil(extent.x() / grid.cell));
  grid.rows = static_cast<int>(std::ceil(extent.y() / grid.cell));
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> bottom(grid.size(), kNone);  // Of what moves.
  std::vector<double> top(grid.size(), -kNone);    // Of what it has to pass.
  for (const Triangle& triangle : own) {
    Rasterise(grid, triangle,
              [&bottom](std::size_t i, double z) { bottom[i] = std::min(bottom[i], z); });
  }
  for (const Triangle& triangle : others) {
    Rasterise(grid, triangle, [&top](std::size_t i, double z) { top[i] = std::max(top[i], z); });
  }
  std::vector<bool> is_blocked(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    is_blocked[i] = top[i] > bottom[i] + 2 * kDepthTolerance;
  }
  const double deepest = CalcDeepestCell(grid, is_blocked);
  return deepest > 0 ? (2 * deepest - 1) * grid.cell : 0;
}

}  // namespace hvas::sequence
