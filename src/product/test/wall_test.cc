// The thinnest wall of parts whose walls are known.

#include "product/wall.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "product/test/flat_face.h"

namespace hvas::product {
namespace {

using testing::AddFlatFace;

/** Adds the side faces and ends of a prism along z; the outline is counter-clockwise. */
void AddPrism(const std::vector<Eigen::Vector2d>& outline, double height, Part* part) {
  std::vector<Vec3> low;
  std::vector<Vec3> high;
  for (const Eigen::Vector2d& p : outline) {
    high.emplace_back(p.x(), p.y(), height);
    low.insert(low.begin(), Vec3(p.x(), p.y(), 0));
  }
  AddFlatFace(low, part);
  AddFlatFace(high, part);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    AddFlatFace(
        {{a.x(), a.y(), 0}, {b.x(), b.y(), 0}, {b.x(), b.y(), height}, {a.x(), a.y(), height}},
        part);
  }
}

TEST(ThinnestWall, OfAPlateIsItsThickness) {
  Part part;
  AddPrism({{0, 0}, {40e-3, 0}, {40e-3, 30e-3}, {0, 30e-3}}, 1.2e-3, &part);
  const auto wall = CalcThinnestWall(part);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 1.2e-3, 1e-12);
}

TEST(ThinnestWall, OfABracketIsItsThinnerLeg) {
  Part part;  // an L without its concave ends being cut into convex ones: two prisms side by side
  AddPrism({{0, 0}, {50e-3, 0}, {50e-3, 6e-3}, {0, 6e-3}}, 20e-3, &part);
  AddPrism({{60e-3, 0}, {62.5e-3, 0}, {62.5e-3, 45e-3}, {60e-3, 45e-3}}, 20e-3, &part);
  const auto wall = CalcThinnestWall(part);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 2.5e-3, 1e-12);
}

TEST(ThinnestWall, EdgesOfAWedgeAreNoWalls) {
  Part part;  // an equilateral triangle: no two of its sides look opposite ways
  const double height = 10e-3 * std::numbers::sqrt3;
  AddPrism({{0, 0}, {20e-3, 0}, {10e-3, height}}, 35e-3, &part);
  const auto wall = CalcThinnestWall(part);
  ASSERT_TRUE(wall);
  EXPECT_NEAR(*wall, 35e-3, 1e-12);  // from end to end
}

TEST(ThinnestWall, OfASurfaceThatEnclosesNothingIsNotKnown) {
  Part part;
  AddFlatFace({{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}}, &part);
  EXPECT_FALSE(CalcThinnestWall(part));
}

}  // namespace
}  // namespace hvas::product
