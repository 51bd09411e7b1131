#include "product/face_adjacency.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "product/test/flat_face.h"

namespace hvas::product {
namespace {

using testing::AddFlatFace;

constexpr double kTolerance = 2e-6;  // [m]

/** An L extruded along z; `noise` moves each face's own vertices. */
Part MakeAngle(double noise) {
  const std::vector<Vec3> profile{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  const Vec3 up(0, 0, 2);
  Part part;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vec3& a = profile[i];
    const Vec3& b = profile[(i + 1) % profile.size()];
    const Vec3 shift = noise * Vec3(std::sin(7.0 * static_cast<double>(i)), 0.4, -0.5);
    AddFlatFace({a + shift, b + shift, b + up + shift, a + up + shift}, &part);
  }
  AddFlatFace({{0, 3, 0}, {1, 3, 0}, {1, 1, 0}, {3, 1, 0}, {3, 0, 0}, {0, 0, 0}}, &part);
  return part;  // Open at the top.
}

TEST(FaceAdjacency, TellsInnerFromOuterEdgesAndOpenBorders) {
  for (const double noise : {0.0, 5e-7}) {
    const Part part = MakeAngle(noise);
    const FaceAdjacency adjacency(part, kTolerance);
    int concave = 0;
    for (std::uint32_t f = 0; f < 6; ++f) {
      const auto neighbours = adjacency.neighbours(FaceId(f));
      ASSERT_EQ(neighbours.size(), 3u) << f;  // Two walls and the bottom.
      double open = 0;
      for (const FaceEdge& edge : adjacency.edges(FaceId(f))) {
        open += edge.sense == EdgeSense::kOpen ? (edge.end - edge.start).norm() : 0;
        EXPECT_NEAR(edge.conormal.dot(part.faces[f].surface.axis), 0, 1e-6);
        // Out of the face: away from its middle.
        EXPECT_GT(edge.conormal.dot(edge.start - part.faces[f].box_B.centre()), 0);
      }
      EXPECT_NEAR(open, (part.faces[f].box_B.size() - Vec3(0, 0, 2)).norm(), 1e-5);
      for (const FaceNeighbour& neighbour : neighbours) {
        concave += neighbour.Is(EdgeSense::kConcave) ? 1 : 0;
        EXPECT_NEAR(std::abs(neighbour.angle), 0.5 * std::numbers::pi, 1e-5);
      }
    }
    EXPECT_EQ(concave, 2);  // The inner corner, seen from both of its faces.
  }
}

TEST(FaceAdjacency, FacesFartherApartThanTheToleranceDoNotMeet) {
  const FaceAdjacency adjacency(MakeAngle(1e-4), kTolerance);
  EXPECT_TRUE(adjacency.neighbours(FaceId(0)).empty());
}

TEST(FaceAdjacency, TakesPartsWithoutFacesAndPointsThatAreNoNumbers) {
  EXPECT_NO_FATAL_FAILURE(FaceAdjacency(Part(), kTolerance));
  Part part = MakeAngle(0);
  part.mesh.vertices[0].x() = std::nan("");
  const FaceAdjacency adjacency(part, kTolerance);
  EXPECT_EQ(adjacency.neighbours(FaceId(2)).size(), 3u);
}

}  // namespace
}  // namespace hvas::product
