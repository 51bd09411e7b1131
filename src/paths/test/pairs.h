#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "contact/shape.h"
#include "paths/way.h"

/** Pairs of parts that come apart in one way only, made in code, and solids to make them of. */
namespace hvas::paths::testing {

/** A solid of cells of a grid with uneven steps: closed, with one flat face for each plane. */
class CellSolid {
 public:
  /** @param steps  Coordinates of the grid's planes along x, y and z, rising [m]. */
  explicit CellSolid(std::array<std::vector<double>, 3> steps) : steps_(std::move(steps)) {
    is_full_.assign(Count(0) * Count(1) * Count(2), false);
  }

  /** Fills (or empties) all cells whose centre is in a box. */
  CellSolid& Set(const Vec3& low, const Vec3& high, bool is_full = true) {
    for (std::size_t i = 0; i < Count(0); ++i) {
      for (std::size_t j = 0; j < Count(1); ++j) {
        for (std::size_t k = 0; k < Count(2); ++k) {
          const Vec3 c(Middle(0, i), Middle(1, j), Middle(2, k));
          if ((c.array() > low.array()).all() && (c.array() < high.array()).all()) {
            is_full_[Index(i, j, k)] = is_full;
          }
        }
      }
    }
    return *this;
  }

  [[nodiscard]] contact::ShapeSource Make() const {
    contact::ShapeSource source;
    std::map<std::array<std::size_t, 3>, std::uint32_t> vertices;
    std::map<std::pair<int, std::size_t>, std::uint32_t> faces;  // Axis and side; plane.
    const auto vertex = [&](const std::array<std::size_t, 3>& at) {
      const auto [entry, is_new] =
          vertices.emplace(at, static_cast<std::uint32_t>(source.vertices.size()));
      if (is_new) {
        source.vertices.emplace_back(steps_[0][at[0]], steps_[1][at[1]], steps_[2][at[2]]);
      }
      return entry->second;
    };
    for (std::size_t i = 0; i < Count(0); ++i) {
      for (std::size_t j = 0; j < Count(1); ++j) {
        for (std::size_t k = 0; k < Count(2); ++k) {
          for (int side = 0; side < 6 && is_full_[Index(i, j, k)]; ++side) {
            AddSide({i, j, k}, side, vertex, &faces, &source);
          }
        }
      }
    }
    return source;
  }

 private:
  [[nodiscard]] std::size_t Count(std::size_t axis) const { return steps_[axis].size() - 1; }

  [[nodiscard]] double Middle(std::size_t axis, std::size_t i) const {
    return 0.5 * (steps_[axis][i] + steps_[axis][i + 1]);
  }

  [[nodiscard]] std::size_t Index(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * Count(1) + j) * Count(2) + k;
  }

  template <typename Vertex>
  void AddSide(const std::array<std::size_t, 3>& cell, int side, const Vertex& vertex,
               std::map<std::pair<int, std::size_t>, std::uint32_t>* faces,
               contact::ShapeSource* source) const {
    const auto axis = static_cast<std::size_t>(side / 2);
    const bool is_high = side % 2 == 1;
    std::array<std::size_t, 3> beside = cell;
    if (is_high ? cell[axis] + 1 < Count(axis) : cell[axis] > 0) {
      beside[axis] += is_high ? 1 : static_cast<std::size_t>(-1);
      if (is_full_[Index(beside[0], beside[1], beside[2])]) {
        return;
      }
    }
    const std::size_t plane = cell[axis] + (is_high ? 1 : 0);
    const auto [face, is_new] =
        faces->emplace(std::pair(side, plane), static_cast<std::uint32_t>(source->faces.size()));
    if (is_new) {
      const Vec3 normal = (is_high ? 1.0 : -1.0) * Vec3::Unit(static_cast<Eigen::Index>(axis));
      const Vec3 origin = steps_[axis][plane] * Vec3::Unit(static_cast<Eigen::Index>(axis));
      source->faces.push_back({spatial::SurfaceKind::kPlane, origin, normal, 0, 0, 1});
    }
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<std::array<std::size_t, 3>, 4> corner;
    for (std::size_t n = 0; n < 4; ++n) {
      corner[n] = cell;
      corner[n][axis] = plane;
      corner[n][u] += n == 1 || n == 2 ? 1 : 0;
      corner[n][v] += n >= 2 ? 1 : 0;
    }
    std::array<std::uint32_t, 4> at{vertex(corner[0]), vertex(corner[1]), vertex(corner[2]),
                                    vertex(corner[3])};
    if (!is_high) {
      std::swap(at[1], at[3]);
    }
    source->triangles.push_back({at[0], at[1], at[2]});
    source->triangles.push_back({at[0], at[2], at[3]});
    source->triangle_face.insert(source->triangle_face.end(), 2, face->second);
  }

  std::array<std::vector<double>, 3> steps_;
  std::vector<bool> is_full_;
};

/** A pair: the part that moves, what it is in, and the pose of the part in it. */
struct Pair {
  std::string name;
  std::shared_ptr<const contact::Shape> part, around;
  spatial::Pose X_AB;  ///< Pose of the part B in what is around it, A.
  double tolerance{20e-6};
};

[[nodiscard]] std::shared_ptr<const contact::Shape> MakeShape(const contact::ShapeSource& source,
                                                              double voxel = 0);

/** A layer of a body about z: sectors of a ring. */
struct PolarLayer {
  double low{0}, high{0};      ///< Along z [m].
  std::vector<double> radius;  ///< Radius of each sector, outside (or inside for a hole) [m].
};

/** A body about z whose radius is given for each sector of each layer: cylinders and planes.
 @param outside  0: a shaft. Else a hole with these radii in a cylinder of this radius [m]. */
[[nodiscard]] contact::ShapeSource MakePolar(const std::vector<PolarLayer>& layers, double outside);

/** A thread: a shaft whose radius goes between minor and major along a helix, or a hole of such a
 form in a cylinder. Freeform; closed.
 @param outside  0: a shaft. */
[[nodiscard]] contact::ShapeSource MakeThread(double minor, double major, double pitch, double low,
                                              double high, double outside);

[[nodiscard]] Pair MakeHook(double gap);          ///< An L in a channel around a corner.
[[nodiscard]] Pair MakeZigZag(double gap);        ///< A bolt with a handle in a stepped slot.
[[nodiscard]] Pair MakeBayonet(double gap);       ///< Lugs that turn before they go out.
[[nodiscard]] Pair MakeKeyhole(double gap);       ///< A key that turns a quarter in its hole.
[[nodiscard]] Pair MakeLippedWindow(double gap);  ///< A plate tilted out of a window with a lip.
[[nodiscard]] Pair MakeRailHook(double gap);      ///< A hook that swings off a rail.
[[nodiscard]] Pair MakeCornerRod(double gap);     ///< A bent rod through two plates.
[[nodiscard]] Pair MakeNut(double gap);           ///< A threaded sleeve on its bolt.
[[nodiscard]] Pair MakeCaptive(double gap);       ///< Has no way out.

}  // namespace hvas::paths::testing
