#include "product/polygons.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "product/features.h"
#include "product/test/flat_face.h"
#include "product/test/round_face.h"

namespace hvas::product {
namespace {

using testing::AddFlatFace;
using testing::AddRoundFace;

constexpr double kPi = std::numbers::pi;
constexpr double kNear = 1e-9;  // [m]

/** A wall from (x0, y0) to (x1, y1) that looks to the right of this way. */
void AddWall(double x0, double y0, double x1, double y1, double low, double high, Part* part) {
  AddFlatFace({Vec3(x0, y0, low), Vec3(x1, y1, low), Vec3(x1, y1, high), Vec3(x0, y0, high)}, part);
}

/** The walls of a regular polygon about z: outside of the material, or of a bore. */
void AddRegularWalls(int sides, double across, bool is_recess, double low, double high,
                     Part* part) {
  const double reach = 0.5 * across / std::cos(kPi / sides);
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * kPi * i / sides + 0.2;
    const double b = 2 * kPi * (i + 1) / sides + 0.2;
    const double from = is_recess ? b : a;
    const double to = is_recess ? a : b;
    AddWall(reach * std::cos(from), reach * std::sin(from), reach * std::cos(to),
            reach * std::sin(to), low, high, part);
  }
}

/** A flat across z with corners at a radius, and a round hole in it where `hole` is not 0. */
void AddLid(double radius, double height, double up, double hole, Part* part) {
  constexpr int kSides = 24;
  for (int i = 0; i < kSides; ++i) {
    const double a = 2 * kPi * i / kSides;
    const double b = 2 * kPi * (i + 1) / kSides;
    const auto at = [height](double r, double angle) {
      return Vec3(r * std::cos(angle), r * std::sin(angle), height);
    };
    std::vector<Vec3> corners{at(hole, a), at(radius, a), at(radius, b), at(hole, b)};
    if (hole == 0) {
      corners.erase(corners.begin());
    }
    if (up < 0) {
      corners = {corners.rbegin(), corners.rend()};
    }
    AddFlatFace(corners, part);
  }
}

std::vector<PolygonForm> Find(Part* part) {
  RecognitionLimits limits;
  BuildFeatures(part);
  return FindPolygons(*part, 2e-6, &limits);
}

TEST(Polygons, EachRegularBoreHasItsSidesWidthAndDepthAndAnOctagonIsNoSquare) {
  for (const int sides : {4, 6, 8}) {
    for (const double across : {3e-3, 12.7e-3, 60e-3}) {
      SCOPED_TRACE(sides);
      Part part;
      AddRegularWalls(sides, across, true, 0, 8e-3, &part);
      AddRoundFace(&part, 0, across, 1, 0, 2 * kPi, 0, 8e-3);
      const auto found = Find(&part);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_EQ(found[0].kind, PolygonKind::kRegular);
      EXPECT_EQ(found[0].sides, sides);
      EXPECT_TRUE(found[0].is_recess);
      EXPECT_TRUE(found[0].is_through);
      EXPECT_NEAR(found[0].width, across, kNear);
      EXPECT_NEAR(found[0].depth, 8e-3, kNear);
      EXPECT_NEAR(std::abs(found[0].axis_B.z()), 1, kNear);
    }
  }
}

TEST(Polygons, APocketWithAHoleInItsFloorEndsThereAndIsEnteredFromItsMouth) {
  for (const double hole : {0.0, 8.4e-3}) {
    Part holder;
    AddRegularWalls(6, 13.2e-3, true, 4e-3, 11e-3, &holder);
    AddLid(9e-3, 4e-3, 1, 0.5 * hole, &holder);
    const auto found = Find(&holder);
    ASSERT_EQ(found.size(), 1U) << hole;
    EXPECT_FALSE(found[0].is_through) << hole;
    EXPECT_NEAR(found[0].origin_B.z(), 11e-3, kNear);
    EXPECT_NEAR(found[0].axis_B.z(), -1, kNear);
  }
}

/** A round about z with flats at a distance from the axis: one (D) or two. */
Part MakeFlatted(double radius, double distance, int flats, bool is_hole) {
  Part part;
  const double half = std::acos(distance / radius);
  const double chord = radius * std::sin(half);
  const double outward = is_hole ? -1 : 1;
  for (int i = 0; i < flats; ++i) {
    const double turn = kPi * i;
    const double next = i + 1 < flats ? kPi : 2 * kPi - kPi * i;
    AddRoundFace(&part, 0, radius, outward, turn + half, next - 2 * half, 0, 10e-3);
    const double sign = i == 0 ? 1 : -1;
    const double y = is_hole ? -sign * chord : sign * chord;
    AddWall(sign * distance, -y, sign * distance, y, 0, 10e-3, &part);
  }
  return part;
}

TEST(Polygons, AFlatOnARoundIsADAndTwoAreADoubleD) {
  for (const bool is_hole : {false, true}) {
    for (const auto& [radius, distance] :
         {std::pair(2.5e-3, 2e-3), std::pair(3e-3, 2.5e-3), std::pair(20e-3, 17e-3)}) {
      for (const int flats : {1, 2}) {
        SCOPED_TRACE(flats);
        Part part = MakeFlatted(radius, distance, flats, is_hole);
        const auto found = Find(&part);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].kind, PolygonKind::kFlatted);
        EXPECT_EQ(found[0].sides, flats);
        EXPECT_EQ(found[0].is_recess, is_hole);
        EXPECT_NEAR(found[0].diameter, 2 * radius, kNear);
        EXPECT_NEAR(found[0].width, flats == 1 ? radius + distance : 2 * distance, kNear);
      }
    }
  }
}

/** Teeth with parallel flanks about z on a round of the bottoms' radius. */
Part MakeSpline(int teeth, double bottom, double top, double width, bool is_hub) {
  Part part;
  const double inner = is_hub ? top : bottom;
  const double half = std::asin(0.5 * width / inner);
  for (int i = 0; i < teeth; ++i) {
    const double middle = 2 * kPi * i / teeth;
    AddRoundFace(&part, 0, inner, is_hub ? -1 : 1, middle + half, 2 * kPi / teeth - 2 * half, 0,
                 15e-3);
    const double top_half = std::asin(0.5 * width / (is_hub ? bottom : top));
    AddRoundFace(&part, 0, is_hub ? bottom : top, is_hub ? -1 : 1, middle - top_half, 2 * top_half,
                 0, 15e-3);
    const Vec3 r(std::cos(middle), std::sin(middle), 0);
    const Vec3 t(-r.y(), r.x(), 0);
    for (const double side : {1.0, -1.0}) {
      const Vec3 a = bottom * r + 0.5 * side * width * t;
      const Vec3 b = top * r + 0.5 * side * width * t;
      // The flanks of a tooth look away from it, those of a hub's groove into it.
      const bool is_turned = (side > 0) == is_hub;
      const Vec3& from = is_turned ? a : b;
      const Vec3& to = is_turned ? b : a;
      AddWall(from.x(), from.y(), to.x(), to.y(), 0, 15e-3, &part);
    }
  }
  return part;
}

TEST(Polygons, TeethWithFlatFlanksAreASplineWithTheirNumber) {
  // ISO 14: 6x23x26, 8x32x36 and 8x52x58, the teeth 6, 6 and 10 mm wide.
  struct Size {
    int teeth;
    double bottom, top, width;
  };

  for (const Size& size :
       {Size{6, 11.5e-3, 13e-3, 6e-3}, Size{8, 16e-3, 18e-3, 6e-3}, Size{8, 26e-3, 29e-3, 10e-3}}) {
    SCOPED_TRACE(size.teeth);
    Part shaft = MakeSpline(size.teeth, size.bottom, size.top, size.width, false);
    const auto found = Find(&shaft);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].kind, PolygonKind::kSpline);
    EXPECT_EQ(found[0].sides, size.teeth);
    EXPECT_FALSE(found[0].is_recess);
    EXPECT_NEAR(found[0].width, size.width, kNear);
    EXPECT_NEAR(found[0].depth, 15e-3, kNear);
  }
}

TEST(Polygons, ABoxWithUnequalSidesIsNone) {
  Part box;  // 10 by 14: no regular polygon.
  AddWall(-5e-3, -7e-3, 5e-3, -7e-3, 0, 5e-3, &box);
  AddWall(5e-3, -7e-3, 5e-3, 7e-3, 0, 5e-3, &box);
  AddWall(5e-3, 7e-3, -5e-3, 7e-3, 0, 5e-3, &box);
  AddWall(-5e-3, 7e-3, -5e-3, -7e-3, 0, 5e-3, &box);
  EXPECT_TRUE(Find(&box).empty());
}

}  // namespace
}  // namespace hvas::product
