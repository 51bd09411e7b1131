#include "shopfloor/part_symmetry.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::shopfloor {
namespace {

using product::Mesh;

/** A prism along z over a polygon that is star-shaped about the origin. */
void AddPrism(const std::vector<Vec3>& outline, double low, double high, Mesh* mesh) {
  const auto n = static_cast<std::uint32_t>(outline.size());
  const auto base = static_cast<std::uint32_t>(mesh->vertices.size());
  for (const double z : {low, high}) {
    for (const Vec3& p : outline) {
      mesh->vertices.emplace_back(p.x(), p.y(), z);
    }
    mesh->vertices.emplace_back(0, 0, z);
  }
  const std::uint32_t top = base + n + 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh->triangles.push_back({base + i, base + j, top + j});
    mesh->triangles.push_back({base + i, top + j, top + i});
    mesh->triangles.push_back({base + n, base + j, base + i});
    mesh->triangles.push_back({top + n, top + i, top + j});
  }
}

std::vector<Vec3> Polygon(int corners, double radius) {
  std::vector<Vec3> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return outline;
}

product::Part PartOf(Mesh mesh) {
  product::Part part;
  for (const Vec3& p : mesh.vertices) {
    part.box_B.Add(p);
  }
  part.mesh = std::move(mesh);
  return part;
}

product::Part Prism(const std::vector<Vec3>& outline, double length) {
  Mesh mesh;
  AddPrism(outline, 0, length, &mesh);
  return PartOf(std::move(mesh));
}

PartSymmetry AlphaBeta(int alpha_deg, int beta_deg) {
  return {alpha_deg, beta_deg};
}

// The examples follow from the two definitions (Whitney, Fig. 15-1).
TEST(PartSymmetryTest, APlainCylinderTakesEitherEndAtAnyTurn) {
  EXPECT_EQ(FindSymmetry(Prism(Polygon(96, 10e-3), 40e-3), Vec3::UnitZ()), AlphaBeta(180, 0));
}

TEST(PartSymmetryTest, AHeadedPinHasOneEnd) {
  Mesh mesh;
  AddPrism(Polygon(96, 5e-3), 0, 30e-3, &mesh);
  AddPrism(Polygon(96, 9e-3), 30e-3, 36e-3, &mesh);
  EXPECT_EQ(FindSymmetry(PartOf(mesh), Vec3::UnitZ()), AlphaBeta(360, 0));
}

TEST(PartSymmetryTest, PrismsRepeatByTheirCorners) {
  EXPECT_EQ(FindSymmetry(Prism(Polygon(4, 15e-3), 60e-3), Vec3::UnitZ()), AlphaBeta(180, 90));
  EXPECT_EQ(FindSymmetry(Prism(Polygon(3, 15e-3), 60e-3), Vec3::UnitZ()), AlphaBeta(180, 120));
  EXPECT_EQ(FindSymmetry(Prism(Polygon(6, 15e-3), 60e-3), Vec3::UnitZ()), AlphaBeta(180, 60));
}

TEST(PartSymmetryTest, ARectangularBlockTakesEitherEndAndHalfATurn) {
  const std::vector<Vec3> outline{
      {20e-3, 10e-3, 0}, {-20e-3, 10e-3, 0}, {-20e-3, -10e-3, 0}, {20e-3, -10e-3, 0}};
  EXPECT_EQ(FindSymmetry(Prism(outline, 60e-3), Vec3::UnitZ()), AlphaBeta(180, 180));
}

TEST(PartSymmetryTest, ACubeTakesAnyFace) {
  const std::vector<Vec3> outline{
      {10e-3, 10e-3, 0}, {-10e-3, 10e-3, 0}, {-10e-3, -10e-3, 0}, {10e-3, -10e-3, 0}};
  EXPECT_EQ(FindSymmetry(Prism(outline, 20e-3), Vec3::UnitZ()), AlphaBeta(90, 90));
}

TEST(PartSymmetryTest, AGearRepeatsByItsTeeth) {
  std::vector<Vec3> outline;
  constexpr int kTeeth = 20;
  for (int i = 0; i < 4 * kTeeth; ++i) {
    const double angle = 2 * std::numbers::pi * i / (4 * kTeeth);
    const double radius = i % 4 < 2 ? 20e-3 : 17e-3;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  EXPECT_EQ(FindSymmetry(Prism(outline, 10e-3), Vec3::UnitZ()), AlphaBeta(180, 18));
}

TEST(PartSymmetryTest, AnOddPartHasOneWay) {
  const std::vector<Vec3> outline{
      {20e-3, 5e-3, 0}, {2e-3, 12e-3, 0}, {-20e-3, -3e-3, 0}, {5e-3, -9e-3, 0}};
  Mesh mesh;
  AddPrism(outline, 0, 10e-3, &mesh);
  AddPrism(Polygon(16, 3e-3), 10e-3, 25e-3, &mesh);
  EXPECT_EQ(FindSymmetry(PartOf(mesh), Vec3::UnitZ()), AlphaBeta(360, 360));
  EXPECT_EQ(FindSymmetry(product::Part(), Vec3::UnitZ()), AlphaBeta(360, 360))
      << "nothing is known";
}

}  // namespace
}  // namespace hvas::shopfloor
