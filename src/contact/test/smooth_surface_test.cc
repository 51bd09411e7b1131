// The smooth surface of freeform faces against the surfaces that their meshes were made of.

#include "contact/smooth_surface.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

constexpr double kMajor = 20e-3;
constexpr double kMinor = 3e-3;

ShapeSource WithoutSurfaces(ShapeSource source) {
  for (spatial::Surface& face : source.faces) {
    face = {};
  }
  return source;
}

/** A mesh with its bends, and how far they leave it. */
struct Curved {
  Mesh mesh;
  ExactTable exact;

  explicit Curved(const ShapeSource& source) : mesh(MakeMesh(source, Vec3::Zero())) {
    spatial::Box box;
    for (const Vec3& v : mesh.vertices) {
      box.Add(v);
    }
    exact.faces = source.faces;
    exact.deviation.assign(exact.faces.size(), 0.0);
    FindBends(box.size().norm(), &exact, &mesh);
  }
};

struct Errors {
  double distance{0};
  double direction{0};  // [rad]
};

/** Largest errors of points within 50 um of the surface of a ring. */
Errors OfRing(double deviation) {
  const Curved ring(WithoutSurfaces(testing::Ring(kMajor, kMinor, deviation)));
  Random random(7);
  Errors worst;
  for (int i = 0; i < 2000; ++i) {
    const auto t = static_cast<std::uint32_t>(random.Uniform() *
                                              static_cast<double>(ring.mesh.triangles.size()));
    const CurvedPoint seen =
        PointOfPatch(ring.mesh, t, 0.6 * random.Uniform(), 0.4 * random.Uniform());
    const Vec3 p = seen.q + random.Uniform(-50e-6, 50e-6) * seen.normal;
    CurvedPoint foot;
    EXPECT_TRUE(FindFoot(ring.mesh, t, p, FootOn::kSurface, &foot));
    const double radius = std::hypot(p.x(), p.y());
    const Vec3 middle(kMajor * p.x() / radius, kMajor * p.y() / radius, 0);
    const double truth = (p - middle).norm() - kMinor;
    worst.distance = std::max(worst.distance, std::abs((p - foot.q).dot(foot.normal) - truth));
    worst.direction =
        std::max(worst.direction, foot.normal.cross((p - middle).normalized()).norm());
  }
  return worst;
}

// Chords of length h leave an arc by h^2 / 8R. Normals found from corners are wrong by h^2, and the
// patches that have them by h^3: of a mesh four times as close, by an eighth.
TEST(SmoothSurface, IsOfThirdOrder) {
  const Errors coarse = OfRing(8e-6);
  const Errors middle = OfRing(2e-6);
  const Errors fine = OfRing(0.5e-6);
  EXPECT_LT(coarse.distance, 0.05 * 8e-6);
  EXPECT_LT(middle.distance, coarse.distance / 7);
  EXPECT_LT(fine.distance, middle.distance / 7);
  EXPECT_LT(middle.direction, coarse.direction / 3.5);
  EXPECT_LT(fine.direction, middle.direction / 3.5);
}

TEST(SmoothSurface, HasNoGapBetweenNeighbours) {
  const Curved ring(WithoutSurfaces(testing::Ring(kMajor, kMinor, 4e-6)));
  constexpr double kCorners[3][2] = {{0, 0}, {1, 0}, {0, 1}};
  const auto on_edge = [&](std::uint32_t t, std::uint32_t from, std::uint32_t to, double share) {
    double u = 0;
    double v = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = ring.mesh.triangles[t][k];
      const double weight = corner == from ? 1 - share : (corner == to ? share : 0);
      u += weight * kCorners[k][0];
      v += weight * kCorners[k][1];
    }
    return PointOfPatch(ring.mesh, t, u, v).q;
  };
  double widest = 0;
  for (std::uint32_t t = 0; t < ring.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = ring.mesh.triangles[t][k];
      const std::uint32_t to = ring.mesh.triangles[t][(k + 1) % 3];
      const Vec3 gap =
          on_edge(t, from, to, 0.3) - on_edge(ring.mesh.neighbour[t][k], from, to, 0.3);
      widest = std::max(widest, gap.norm());
    }
  }
  EXPECT_LT(widest, 1e-12);
}

// Flat faces of a freeform one, and meshes that are too coarse to be of a smooth face.
TEST(SmoothSurface, LeavesWhatIsNotSmoothAsItIs) {
  const Curved block(WithoutSurfaces(testing::Block({10e-3, 8e-3, 5e-3})));
  EXPECT_EQ(*std::max_element(block.exact.deviation.begin(), block.exact.deviation.end()), 0);
  const Curved bar(WithoutSurfaces(testing::Shaft(10e-3, 30e-3, 200e-6)));  // Of 16 sides or so.
  EXPECT_LT(bar.exact.deviation[1], 4e-6);
  const Curved shaft(WithoutSurfaces(testing::Shaft(10e-3, 30e-3, 4e-6)));
  EXPECT_NEAR(shaft.exact.deviation[1], 4e-6, 1e-6);
}

TEST(SmoothSurface, EndsWhereItsFaceDoes) {
  const Curved shaft(WithoutSurfaces(testing::Shaft(10e-3, 30e-3, 1e-6)));
  std::uint32_t side = 0;  // Near the y axis.
  while (shaft.mesh.face[side] != 1 || shaft.mesh.NormalOf(side).y() < 0.99) {
    ++side;
  }
  CurvedPoint foot;
  ASSERT_TRUE(FindFoot(shaft.mesh, side, {0, 10.01e-3, 29.9e-3}, FootOn::kFace, &foot));
  EXPECT_TRUE(foot.is_inside);
  EXPECT_NEAR((foot.q - Vec3(0, 10e-3, 29.9e-3)).norm(), 0, 20e-9);
  ASSERT_TRUE(FindFoot(shaft.mesh, side, {0, 10.01e-3, 30.1e-3}, FootOn::kFace, &foot));
  EXPECT_FALSE(foot.is_inside);
  EXPECT_NEAR((foot.q - Vec3(0, 10e-3, 30.1e-3)).norm(), 0, 20e-9) << "it is continued";
  EXPECT_FALSE(FindFoot(shaft.mesh, side, {0, 10.01e-3, 60e-3}, FootOn::kFace, &foot));
}

}  // namespace
}  // namespace hvas::contact
