#include "mates/surface_pairs.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "mates/build_mate.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using product::SurfaceConstraint;
using product::SurfaceConstraintKind;
using spatial::Pose;
using testing::AddCap;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;
using testing::AddRoundFace;

/** A cylinder of `arcs` equal faces from `begin`, cut in `rings` along its length of 20 mm. */
void AddCut(Product* product, FeatureKind kind, int arcs, int rings, double begin) {
  Part* part = AddPart(product, "part");
  Feature feature;
  feature.kind = kind;
  feature.radius = 5e-3;
  feature.span_high = 20e-3;
  feature.coverage = 2 * std::numbers::pi;
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < arcs; ++i) {
      const double sweep = 2 * std::numbers::pi / arcs;
      feature.faces.push_back(AddRoundFace(part, 5e-3, 5e-3, 20e-3 * j / rings,
                                           20e-3 * (j + 1) / rings, begin + i * sweep, sweep));
    }
  }
  part->features.push_back(feature);
}

std::vector<SurfaceConstraint> FindOfCylinders(int arcs_a, int rings_a, int arcs_b, int rings_b,
                                               double turn, double shift) {
  Product product;
  AddCut(&product, FeatureKind::kHole, arcs_a, rings_a, 0);
  AddCut(&product, FeatureKind::kShaft, arcs_b, rings_b, 0);
  const Pose X_WB(spatial::RotationFromVector(Vec3(0, 0, turn)), Vec3(0, 0, shift));
  AddOccurrence(&product, PartId(0), Pose());
  AddOccurrence(&product, PartId(1), X_WB);
  return FindSurfacePairs(
      product, BuildMate(product, MateKind::kAxisHole, {OccurrenceId(0), FeatureId(0), Pose()},
                         {OccurrenceId(1), FeatureId(0), X_WB}));
}

// X2, layer J, counted by hand.
TEST(FindSurfacePairs, FacesOfCylindersFaceEachOtherByTurnAndLength) {
  EXPECT_EQ(FindOfCylinders(1, 1, 1, 1, 0, 0).size(), 1U);
  EXPECT_EQ(FindOfCylinders(2, 1, 2, 1, 0, 0).size(), 2U);  // Half on half.
  EXPECT_EQ(FindOfCylinders(2, 1, 2, 1, std::numbers::pi / 2, 0).size(),
            4U);  // Turned: each on both.
  EXPECT_EQ(FindOfCylinders(2, 1, 4, 1, 0, 0).size(), 4U);
  EXPECT_EQ(FindOfCylinders(1, 4, 1, 1, 0, 0).size(), 4U);     // Rings.
  EXPECT_EQ(FindOfCylinders(1, 4, 1, 1, 0, 9e-3).size(), 3U);  // The first is not reached.
  EXPECT_EQ(FindOfCylinders(2, 2, 2, 2, 0, 10e-3).size(), 2U);
  for (const SurfaceConstraint& pair : FindOfCylinders(2, 1, 4, 1, 0, 0)) {
    EXPECT_EQ(pair.kind, SurfaceConstraintKind::kCoaxial);
    EXPECT_EQ(pair.a.index(), pair.b.index() / 2);
  }
}

TEST(FindSurfacePairs, FacesOfPlanesFaceEachOtherWhereTheyOverlap) {
  Product product;
  AddPart(&product, "rail");
  AddPart(&product, "pads");
  Feature rail;
  Feature pads;
  for (int i = 0; i < 3; ++i) {
    AddRectangle(&product.parts[0], Vec3(20e-3 * i, 0, 0), Vec3::UnitZ(), 8e-3, 8e-3);
    rail.faces.emplace_back(static_cast<std::size_t>(i));
  }
  AddRectangle(&product.parts[1], Vec3(10e-3, 0, 0), -Vec3::UnitZ(), 9e-3, 3e-3);
  AddRectangle(&product.parts[1], Vec3(40e-3, 30e-3, 0), -Vec3::UnitZ(), 9e-3, 3e-3);
  pads.faces = {product::FaceId(0), product::FaceId(1)};
  pads.axis_B = -Vec3::UnitZ();
  product.parts[0].features = {rail};
  product.parts[1].features = {pads};
  AddOccurrence(&product, PartId(0), Pose());
  AddOccurrence(&product, PartId(1), Pose());
  Mate mate = BuildMate(product, MateKind::kFaceFace, {OccurrenceId(0), FeatureId(0), Pose()},
                        {OccurrenceId(1), FeatureId(0), Pose()});
  const PlaneOverlap overlap = CalcPlaneOverlap(product, mate);
  EXPECT_NEAR(overlap.area, 2 * 7e-3 * 6e-3, 1e-15);
  EXPECT_LT((mate.a.X_BM * overlap.p_MQ - Vec3(10e-3, 0, 0)).norm(), 1e-12);
  mate.overlap = overlap.area;
  // The first pad lies across the gap between two faces of the rail, the second on none.
  const std::vector<SurfaceConstraint> pairs = FindSurfacePairs(product, mate);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].a.index(), 0U);
  EXPECT_EQ(pairs[1].a.index(), 1U);
  EXPECT_EQ(pairs[0].b.index() + pairs[1].b.index(), 0U);
}

TEST(CalcSphereOverlap, IsTheSolidAngleThatBothCover) {
  for (const double end :
       {0.3 * std::numbers::pi, 0.5 * std::numbers::pi, 0.9 * std::numbers::pi}) {
    Product product;
    AddCap(AddPart(&product, "socket"), FeatureKind::kSocket, Vec3::Zero(), 10e-3, 0, end);
    AddCap(AddPart(&product, "ball"), FeatureKind::kBall, Vec3::Zero(), 9e-3,
           0.2 * std::numbers::pi, std::numbers::pi);
    AddOccurrence(&product, PartId(0), Pose());
    AddOccurrence(&product, PartId(1), Pose());
    const Mate mate =
        BuildMate(product, MateKind::kSphereSeat, {OccurrenceId(0), FeatureId(0), Pose()},
                  {OccurrenceId(1), FeatureId(0), Pose()});
    const double whole = 4 * std::numbers::pi * 81e-6;
    const double zone =
        2 * std::numbers::pi * 81e-6 * (std::cos(0.2 * std::numbers::pi) - std::cos(end));
    EXPECT_NEAR(CalcSphereOverlap(product, mate), zone, 0.01 * whole);
    EXPECT_EQ(FindSurfacePairs(product, mate).size(), 1U);
  }
}

}  // namespace
}  // namespace hvas::mates
