#include "product/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "product/axis_features.h"
#include "product/hole_patterns.h"
#include "product/test/round_face.h"

namespace hvas::product {
namespace {

using testing::AddQuad;
using testing::AddRoundFace;
using testing::StartFace;

/** A square of the plane z = height that faces up or down. */
void AddSquare(Part* part, double x, double height, double side, double up) {
  Surface surface;
  surface.origin = {0, 0, height};
  surface.kind = SurfaceKind::kPlane;
  surface.axis = {0, 0, up};
  StartFace(part, surface);
  AddQuad(part, {x, 0, height}, {x + side, 0, height}, {x + side, side, height}, {x, side, height});
}

TEST(BuildFeatures, MergesHalvesAndQuartersIntoOneHole) {
  Part part;
  AddRoundFace(&part, 0, 0.005, -1, 0, std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0, 0.005, -1, std::numbers::pi, 0.5 * std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0, 0.005, -1, 1.5 * std::numbers::pi, 0.5 * std::numbers::pi, 0, 0.01);
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 1u);
  const Feature& hole = part.features[0];
  EXPECT_EQ(hole.kind, FeatureKind::kHole);
  EXPECT_EQ(hole.faces.size(), 3u);
  EXPECT_NEAR(hole.coverage, 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(hole.span_high - hole.span_low, 0.01, 1e-12);
  EXPECT_LT((hole.origin_B - Vec3(0, 0, 0.005)).norm(), 1e-12);
}

TEST(BuildFeatures, JoinsFacesThatTouchAlongTheAxisAndSplitsAtAGap) {
  Part part;
  AddRoundFace(&part, 0, 0.005, 1, 0, 2 * std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0, 0.005, 1, 0, 2 * std::numbers::pi, 0.01, 0.03);
  AddRoundFace(&part, 0, 0.005, 1, 0, 2 * std::numbers::pi, 0.031, 0.04);
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 2u);
  EXPECT_NEAR(part.features[0].span_high - part.features[0].span_low, 0.03, 1e-12);
  EXPECT_EQ(part.features[1].kind, FeatureKind::kShaft);
  // Both halves of the shaft are still known to share their axis.
  ASSERT_EQ(part.inner_constraints.size(), 1u);
  EXPECT_EQ(part.inner_constraints[0].kind, InnerConstraintKind::kCoaxial);
}

TEST(BuildFeatures, KeepsHolesAndShaftsOfOneAxisApart) {
  Part part;
  AddRoundFace(&part, 0, 0.005, -1, 0, 2 * std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0, 0.005, 1, 0, 2 * std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0, 0.00501, 1, 0, 2 * std::numbers::pi, 0, 0.01);
  BuildFeatures(&part);
  EXPECT_EQ(part.features.size(), 3u);
}

TEST(BuildFeatures, DropsFilletsAndKeepsABoreOpenedByASlit) {
  Part part;
  AddRoundFace(&part, 0, 0.005, 1, 0, 0.5 * std::numbers::pi, 0, 0.01);  // A fillet.
  AddRoundFace(&part, 0.1, 0.005, -1, 0, std::numbers::pi, 0, 0.01);     // One end of a slot.
  AddRoundFace(&part, 0.2, 0.005, -1, 0.1, 1.8 * std::numbers::pi, 0, 0.01);
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 1u);
  EXPECT_NEAR(part.features[0].coverage, 1.8 * std::numbers::pi, 1e-9);
}

TEST(BuildFeatures, KeepsTheRoundEndsOfASlotBehindAllOthers) {
  constexpr double kHalf = std::numbers::pi;
  for (const double outward : {-1.0, 1.0}) {
    Part part;
    AddRoundFace(&part, 0.03, 0.005, outward, -0.5 * kHalf, kHalf, 0, 0.01);
    AddRoundFace(&part, -0.03, 0.005, outward, 0.5 * kHalf, kHalf, 0, 0.01);
    AddRoundFace(&part, -0.1, 0.002, -1, 0, 2 * kHalf, 0, 0.01);
    BuildFeatures(&part);
    ASSERT_EQ(part.features.size(), 3U);
    EXPECT_FALSE(IsRoundEnd(part.features[0]));
    for (const std::size_t i : {1U, 2U}) {
      const Feature& end = part.features[i];
      EXPECT_TRUE(IsRoundEnd(end));
      EXPECT_EQ(end.kind, outward > 0 ? FeatureKind::kShaft : FeatureKind::kHole);
      const Vec3 arc = CalcArcDirection(part, end);
      EXPECT_NEAR(arc.norm(), 2 / kHalf, 2e-3);
      EXPECT_GT(arc.x() * end.origin_B.x(), 0) << "away from the other end";
    }
  }
}

TEST(BuildFeatures, DropsHalfTurnsThatEndNoSlot) {
  constexpr double kHalf = std::numbers::pi;
  const auto count = [](double from, double radius, double outward) {
    Part part;
    AddRoundFace(&part, 0.03, 0.005, 1, -0.5 * kHalf, kHalf, 0, 0.01);
    AddRoundFace(&part, -0.03, radius, outward, from, kHalf, 0, 0.01);
    BuildFeatures(&part);
    return part.features.size();
  };
  EXPECT_EQ(count(0.5 * kHalf, 0.005, 1), 2U);
  EXPECT_EQ(count(-0.5 * kHalf, 0.005, 1), 0U) << "both look the same way";
  EXPECT_EQ(count(0, 0.005, 1), 0U) << "across";
  EXPECT_EQ(count(0.5 * kHalf, 0.006, 1), 0U) << "of another radius";
  EXPECT_EQ(count(0.5 * kHalf, 0.005, -1), 0U) << "of another sense";
}

TEST(BuildFeatures, KeepsArcsThatHoldAPinTogetherAndDropsThoseThatDoNot) {
  const auto count = [](const std::vector<std::pair<double, double>>& arcs_deg, double gap = 0) {
    Part part;
    double low = 0;
    for (const auto& [from_deg, sweep_deg] : arcs_deg) {
      AddRoundFace(&part, 0, 0.005, 1, from_deg * std::numbers::pi / 180,
                   sweep_deg * std::numbers::pi / 180, low, low + 0.01);
      low += gap;
    }
    BuildFeatures(&part);
    return part.features.size();
  };
  EXPECT_EQ(count({{0, 90}, {180, 90}}), 1u);             // A spring pin.
  EXPECT_EQ(count({{0, 30}, {120, 30}, {240, 30}}), 1u);  // Three lands.
  EXPECT_EQ(count({{0, 20}, {180, 20}}), 0u);             // Hardly there.
  EXPECT_EQ(count({{0, 60}, {90, 60}}), 0u);              // Leaves sideways.
  EXPECT_EQ(count({{0, 190}}), 0u);
  EXPECT_EQ(count({{0, 205}}), 1u);
  // Never at one place along the axis: enough only where they are 200 deg together.
  EXPECT_EQ(count({{0, 90}, {180, 90}}, 0.01), 0u);
  EXPECT_EQ(count({{0, 180}, {180, 180}}, 0.01), 1u);
}

TEST(BuildFeatures, ABoreStandsBeforeTheBottomsOfItsSplines) {
  Part part;
  for (const double turn : {0.0, 0.5, 1.0, 1.5}) {
    AddRoundFace(&part, 0, 0.005, -1, turn * std::numbers::pi, 0.25 * std::numbers::pi, 0, 0.01);
    AddRoundFace(&part, 0, 0.006, -1, (turn + 0.25) * std::numbers::pi, 0.25 * std::numbers::pi, 0,
                 0.01);
  }
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 1u);
  EXPECT_NEAR(part.features[0].radius, 0.005, 1e-12);
}

/** A conical face about z with its apex at the origin, from z = low to high. */
void AddCone(Part* part, double half_angle, double outward, double from, double sweep, double low,
             double high) {
  Surface surface;
  surface.kind = SurfaceKind::kCone;
  surface.axis = {0, 0, low < 0 ? -1.0 : 1.0};
  surface.second = half_angle;
  surface.outward = outward;
  StartFace(part, surface);
  constexpr int kSteps = 16;
  const auto at = [&](double angle, double z) {
    const double r = std::abs(z) * std::tan(half_angle);
    return Vec3(r * std::cos(angle), r * std::sin(angle), z);
  };
  for (int i = 0; i < kSteps; ++i) {
    const double a = from + sweep * i / kSteps;
    const double b = from + sweep * (i + 1) / kSteps;
    AddQuad(part, at(a, low), at(b, low), at(b, high), at(a, high));
  }
}

TEST(BuildFeatures, MergesConesOfOneNappeAndSense) {
  Part part;
  AddCone(&part, 0.5, -1, 0, std::numbers::pi, 0.002, 0.004);
  AddCone(&part, 0.5, -1, std::numbers::pi, std::numbers::pi, 0.002, 0.004);
  AddCone(&part, 0.5, 1, 0, 2 * std::numbers::pi, 0.001, 0.002);
  AddCone(&part, 0.5, -1, 0, 2 * std::numbers::pi, -0.004, -0.002);  // The other nappe.
  AddCone(&part, 0.6, -1, 0, 2 * std::numbers::pi, 0.002, 0.004);
  AddCone(&part, 0.4, -1, 0, 0.5 * std::numbers::pi, 0.002, 0.004);  // A quarter is no seat.
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 4u);
  const Feature& seat = part.features[0];
  EXPECT_EQ(seat.kind, FeatureKind::kConeSeat);
  EXPECT_EQ(seat.faces.size(), 2u);
  EXPECT_NEAR(seat.coverage, 2 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(seat.span_low, 0.002, 1e-12);
  EXPECT_NEAR(seat.span_high, 0.004, 1e-12);
  EXPECT_NEAR(seat.radius, 0.004 * std::tan(0.5), 1e-12);
  EXPECT_LT((seat.axis_B - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_EQ(part.features[1].kind, FeatureKind::kTaper);
  // All on one axis.
  EXPECT_EQ(std::count_if(
                part.inner_constraints.begin(), part.inner_constraints.end(),
                [](const InnerConstraint& c) { return c.kind == InnerConstraintKind::kCoaxial; }),
            3);
}

TEST(BuildFeatures, OrdersHolesAndShaftsThenPlanesThenCones) {
  Part part;
  AddCone(&part, 0.5, -1, 0, 2 * std::numbers::pi, 0.002, 0.004);
  AddSquare(&part, 0, 0.02, 0.01, 1);
  AddRoundFace(&part, 0, 0.005, -1, 0, 2 * std::numbers::pi, 0, 0.01);
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 3u);
  EXPECT_EQ(part.features[0].kind, FeatureKind::kHole);
  EXPECT_EQ(part.features[1].kind, FeatureKind::kPlane);
  EXPECT_EQ(part.features[2].kind, FeatureKind::kConeSeat);
}

TEST(BuildFeatures, MergesPadsOfOnePlaneOnly) {
  Part part;
  AddSquare(&part, 0, 0.02, 0.01, 1);
  AddSquare(&part, 0.03, 0.02, 0.01, 1);     // The same plane.
  AddSquare(&part, 0.06, 0.02, 0.01, -1);    // The same plane seen from below.
  AddSquare(&part, 0.09, 0.02001, 0.01, 1);  // 10 um higher.
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 3u);
  EXPECT_EQ(part.features[0].faces.size(), 2u);
  EXPECT_NEAR(part.features[0].area, 2e-4, 1e-12);
  EXPECT_LT((part.features[0].origin_B - Vec3(0.02, 0.005, 0.02)).norm(), 1e-12);
  ASSERT_EQ(part.inner_constraints.size(), 2u);
  EXPECT_EQ(part.inner_constraints[0].kind, InnerConstraintKind::kCoplanar);
  EXPECT_EQ(part.inner_constraints[1].kind, InnerConstraintKind::kParallel);
}

TEST(BuildFeatures, TiesAHoleToThePlaneItIsDrilledInto) {
  Part part;
  AddSquare(&part, -0.05, 0, 0.1, -1);
  AddRoundFace(&part, 0, 0.005, -1, 0, 2 * std::numbers::pi, 0, 0.01);
  AddRoundFace(&part, 0.03, 0.005, -1, 0, 2 * std::numbers::pi, 0, 0.01);
  BuildFeatures(&part);
  ASSERT_EQ(part.features.size(), 3u);  // Holes first.
  EXPECT_EQ(part.features[2].kind, FeatureKind::kPlane);
  const auto count = [&part](InnerConstraintKind kind) {
    return std::count_if(part.inner_constraints.begin(), part.inner_constraints.end(),
                         [kind](const InnerConstraint& c) { return c.kind == kind; });
  };
  EXPECT_EQ(count(InnerConstraintKind::kPerpendicular), 2);
  EXPECT_EQ(count(InnerConstraintKind::kParallel), 1);
  EXPECT_EQ(part.inner_constraints.size(), 3u);
}

TEST(ProductDepth, CountsLevelsOfSubassemblies) {
  Product product;
  product.parts.emplace_back();
  product.subassemblies.resize(2);
  product.subassemblies[0].id = SubassemblyId(0);
  product.subassemblies[1].id = SubassemblyId(1);
  product.subassemblies[1].parent = SubassemblyId(0);
  product.occurrences.resize(1);
  product.occurrences[0].parent = SubassemblyId(0);
  EXPECT_EQ(product.depth(), 1);
  product.occurrences[0].parent = SubassemblyId(1);
  EXPECT_EQ(product.depth(), 2);
}

std::vector<std::string> ListNotes(Part part) {
  Diagnostics diagnostics;
  part.name = "part";
  BuildFeatures(&part, &diagnostics);
  std::vector<std::string> notes;
  for (const Diagnostic& item : diagnostics.items()) {
    EXPECT_EQ(item.code, "limit-features");
    EXPECT_EQ(item.entity, "part");
    notes.push_back(item.message);
  }
  return notes;
}

TEST(Features, FacesOnOneAxisBeyondTheLimitAreReported) {
  for (const int count : {64, 65}) {
    Part part;
    for (int i = 0; i < count; ++i) {  // Lands along a bore, all on one side.
      AddRoundFace(&part, 0, 5e-3, -1, 0.02 * i, 0.01, 0, 10e-3);
    }
    EXPECT_EQ(ListNotes(part).size(), count > 64 ? 1u : 0u) << count;
  }
}

TEST(Features, AxesBeyondTheLimitOfThreadsAreReported) {
  for (const int count : {300, 301}) {
    Part part;
    for (int i = 0; i < count; ++i) {
      AddRoundFace(&part, 10e-3 * i, 2e-3, -1, 0, 2 * std::numbers::pi, 0, 5e-3);
    }
    EXPECT_EQ(ListNotes(part).size(), count > 300 ? 1u : 0u) << count;
  }
}

TEST(Features, HolesBeyondTheLimitsOfPatternsAreReported) {
  const auto count_limits = [](int count) {
    std::vector<Form> holes(static_cast<std::size_t>(count));
    double x = 0;
    for (Form& hole : holes) {  // No two steps are equal: there is no row or grid.
      x += 10e-3 + 0.1e-3 * static_cast<double>(&hole - holes.data());
      hole.kind = FormKind::kThroughHole;
      hole.axis_B = Vec3::UnitZ();
      hole.origin_B = Vec3(x, 0, 0);
    }
    RecognitionLimits limits;
    (void)FindHolePatterns(holes, 10e-6, &limits);
    return limits.items().size();
  };
  EXPECT_EQ(count_limits(60), 0u);
  EXPECT_EQ(count_limits(61), 1u) << "no rows";
  EXPECT_EQ(count_limits(401), 2u) << "neither circles nor rows";
}

TEST(Features, PlanesBeyondTheLimitOfSeatsAreReported) {
  for (const int count : {48, 49}) {
    Part part;
    for (int i = 0; i < count; ++i) {
      AddSquare(&part, 0, 0.1 * i, 10e-3, 1);
    }
    EXPECT_EQ(ListNotes(part).size(), count > 48 ? 1u : 0u) << count;
  }
}

}  // namespace
}  // namespace hvas::product
