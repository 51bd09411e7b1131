#include "paths/surface.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "paths/test/mesh_checks.h"

namespace hvas::paths {
namespace {

/** Positive at the rim. */
template <typename Value>
Grid GridOf(double half, double spacing, const Value& value) {
  Grid grid = MakeGrid(Vec3::Constant(-half), Vec3::Constant(half), spacing);
  grid.values.resize(grid.IndexOf(0, 0, grid.count[2]));
  ForEachNode(grid, {{0, 0, 0}, grid.count}, [&](std::size_t node, const Vec3& p) {
    grid.values[node] = static_cast<float>(value(p));
  });
  return grid;
}

TEST(SurfaceTest, PlaneIsCutExactly) {
  // An octahedron: linear in each of eight corners of space.
  const auto octahedron = [](const Vec3& p) { return p.cwiseAbs().sum() - 1.0; };
  const SurfaceMesh mesh = ExtractSurface(GridOf(1.5, 0.25, octahedron));
  EXPECT_TRUE(testing::IsClosed(mesh));
  for (const Vec3& vertex : mesh.vertices) {
    EXPECT_NEAR(vertex.cwiseAbs().sum(), 1, 2e-3);  // moved off the nodes by 1e-3 of a cell
  }
}

TEST(SurfaceTest, VolumeOfABallConvergesWithTheSquareOfTheSpacing) {
  const auto error_at = [](double spacing) {
    const SurfaceMesh mesh =
        ExtractSurface(GridOf(1.5, spacing, [](const Vec3& p) { return p.norm() - 1; }));
    EXPECT_TRUE(testing::IsClosed(mesh));
    EXPECT_EQ(testing::CalcEuler(mesh), 2);
    return std::abs(CalcVolume(mesh) - 4.0 / 3 * std::numbers::pi);
  };
  const double coarse = error_at(0.1);
  const double fine = error_at(0.05);
  EXPECT_LT(coarse, 0.05);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
}

TEST(SurfaceTest, AnyValuesGiveAClosedSurface) {  // worse than any product
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const SurfaceMesh mesh = ExtractSurface(GridOf(1, 0.2, [&](const Vec3& p) {
      const double value = random.Uniform(-1, 1);
      const bool is_zero = random.Uniform(0, 1) < 0.1;
      return p.cwiseAbs().maxCoeff() > 0.75 ? 1.0 : (is_zero ? 0.0 : value);
    }));
    EXPECT_GT(mesh.triangles.size(), 1000u);
    EXPECT_TRUE(testing::IsClosed(mesh));
    EXPECT_GT(CalcVolume(mesh), 0);
  }
}

}  // namespace
}  // namespace hvas::paths
