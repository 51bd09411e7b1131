#include "product/face_adjacency.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::product {
namespace {

constexpr double kTolerance = 2e-6;  // [m]

/** Appends a flat face of a polygon, as seen from outside. */
void AddPolygon(Part* part, const std::vector<Vec3>& points) {
  Face face;
  face.surface.kind = SurfaceKind::kPlane;
  face.surface.origin = points[0];
  face.surface.axis = (points[1] - points[0]).cross(points[2] - points[0]).normalized();
  face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  for (const Vec3& p : points) {
    part->mesh.vertices.push_back(p);
    face.box_B.Add(p);
    part->box_B.Add(p);
  }
  for (std::uint32_t i = 2; i < points.size(); ++i) {
    part->mesh.triangles.push_back({first, first + i - 1, first + i});
    face.area += 0.5 * (points[i - 1] - points[0]).cross(points[i] - points[0]).norm();
  }
  face.triangle_count = static_cast<std::uint32_t>(points.size()) - 2;
  part->faces.push_back(face);
}

/** An L extruded along z; `noise` moves each face's own vertices. */
Part MakeAngle(double noise) {
  const std::vector<Vec3> profile{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  const Vec3 up(0, 0, 2);
  Part part;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vec3& a = profile[i];
    const Vec3& b = profile[(i + 1) % profile.size()];
    const Vec3 shift = noise * Vec3(std::sin(7.0 * static_cast<double>(i)), 0.4, -0.5);
    AddPolygon(&part, {a + shift, b + shift, b + up + shift, a + up + shift});
  }
  AddPolygon(&part, {{0, 3, 0}, {1, 3, 0}, {1, 1, 0}, {3, 1, 0}, {3, 0, 0}, {0, 0, 0}});
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
