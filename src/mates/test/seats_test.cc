#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"
#include "mates/infer.h"
#include "mates/surface_pairs.h"
#include "mates/test/test_product.h"
#include "spatial/test/random_pose.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Mate;
using product::MateKind;
using product::Part;
using product::Product;
using spatial::Pose;
using spatial::RandomPose;
using testing::AddCap;
using testing::AddCone;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;

/** A plate, top at z = 0, with a countersink of 90 degrees from r = 1.6 mm to 3.2 mm. */
void AddCountersink(Product* product, double half_angle = std::numbers::pi / 4) {
  Part* plate = AddPart(product, "plate");
  const double apex = -3.2e-3 / std::tan(half_angle);
  AddCone(plate, FeatureKind::kConeSeat, Vec3(0, 0, apex), Vec3::UnitZ(), half_angle,
          1.6e-3 / std::tan(half_angle), -apex);
  plate->box_B.Add(Vec3(-20e-3, -20e-3, -5e-3));
  plate->box_B.Add(Vec3(20e-3, 20e-3, 0));
}

/** A head of 90 degrees from r = 1.5 mm to 3 mm; its rim is at z = 0. */
void AddHead(Product* product, double half_angle = std::numbers::pi / 4) {
  Part* head = AddPart(product, "head");
  const double apex = -3e-3 / std::tan(half_angle);
  AddCone(head, FeatureKind::kTaper, Vec3(0, 0, apex), Vec3::UnitZ(), half_angle,
          1.5e-3 / std::tan(half_angle), -apex);
}

Product MakeCountersunk(const Pose& X_WA, const Pose& X_AB,
                        double head_angle = std::numbers::pi / 4) {
  Product product;
  AddCountersink(&product);
  AddHead(&product, head_angle);
  AddOccurrence(&product, product::PartId(0), X_WA);
  AddOccurrence(&product, product::PartId(1), X_WA * X_AB);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

// X2, N1. Both cones lie on r = z + 3.2 mm; they share z from -1.6 mm (r = 1.6) to -0.2 mm (r = 3).
TEST(ConeSeat, AHeadFlushInItsCountersinkSeatsInAnyFrame) {
  Random random(5);
  for (int draw = 0; draw < 20; ++draw) {
    const Pose X_WA = RandomPose(&random, 1);
    const Product product = MakeCountersunk(X_WA, Pose(Vec3(0, 0, -0.2e-3)));
    ASSERT_EQ(product.mates.size(), 1U);
    const Mate& mate = product.mates[0];
    EXPECT_EQ(mate.kind, MateKind::kConeSeat);
    EXPECT_EQ(mate.a.occurrence.index(), 0U);
    EXPECT_NEAR(mate.overlap, 1.4e-3, 1e-12);
    EXPECT_NEAR(mate.hole_radius, 2.3e-3, 1e-12);
    EXPECT_NEAR(mate.shaft_radius, 2.3e-3, 1e-12);
    EXPECT_NEAR(mate.hole_high, 0.9e-3, 1e-12);
    EXPECT_NEAR(mate.shaft_low, -0.8e-3, 1e-12);
    const Pose X_WM = X_WA * mate.a.X_BM;
    EXPECT_LT((X_WM.p() - X_WA * Vec3(0, 0, -0.9e-3)).norm(), 1e-12);
    EXPECT_LT((X_WM.R().col(2) - X_WA.R().col(2)).norm(), 1e-12);
    const Pose X_WN = product.occurrences[1].X_WB * mate.b.X_BM;
    EXPECT_LT((X_WN.p() - X_WM.p()).norm(), 1e-14);
    ASSERT_EQ(mate.surfaces.size(), 1U);
    EXPECT_EQ(mate.surfaces[0].kind, product::SurfaceConstraintKind::kSameCone);
    EXPECT_GT(mate.confidence, 0.95);
    EXPECT_FALSE(mate.fit.has_value());
  }
}

TEST(ConeSeat, GapIsMeasuredAcrossTheConesAndLowersTheConfidence) {
  const Product touching = MakeCountersunk(Pose(), Pose(Vec3(0, 0, -0.2e-3)));
  const Product above = MakeCountersunk(Pose(), Pose(Vec3(0, 0, 0)));
  ASSERT_EQ(above.mates.size(), 1U);
  const Mate& mate = above.mates[0];
  // Lifted by 0.2 mm along the axis: 0.2 mm of radius, 0.2 sin 45 deg across.
  EXPECT_NEAR(mate.hole_radius - mate.shaft_radius, 0.2e-3, 1e-12);
  EXPECT_NE(mate.evidence.find("0.141 mm apart"), std::string::npos) << mate.evidence;
  EXPECT_LT(mate.confidence, touching.mates[0].confidence);
}

struct Unseated {
  const char* what;
  Pose X_AB;
  double head_angle;
};

class ConeSeatRejects : public ::testing::TestWithParam<Unseated> {};

TEST_P(ConeSeatRejects, NoMate) {
  const Product product = MakeCountersunk(Pose(), GetParam().X_AB, GetParam().head_angle);
  EXPECT_TRUE(product.mates.empty()) << GetParam().what;
}

INSTANTIATE_TEST_SUITE_P(
    Limits, ConeSeatRejects,
    ::testing::Values(
        Unseated{"lifted by 0.5 mm: 0.35 mm apart", Pose(Vec3(0, 0, 0.3e-3)), std::numbers::pi / 4},
        Unseated{"sunk by 0.5 mm", Pose(Vec3(0, 0, -0.7e-3)), std::numbers::pi / 4},
        Unseated{"beside the axis", Pose(Vec3(30e-6, 0, -0.2e-3)), std::numbers::pi / 4},
        Unseated{"82 degrees in 90", Pose(Vec3(0, 0, -0.2e-3)), units::FromDeg(41)},
        Unseated{"upside down, a chamfer against a chamfer",
                 Pose(Quat(0, 1, 0, 0), Vec3(0, 0, -2.6e-3)), std::numbers::pi / 4}));

// Pitfall l: the countersunk screw keeps its axis mate beside its seat; together they leave one
// turn.
TEST(ConeSeat, ACountersunkScrewHasAnAxisAndASeatThatLeaveOneTurn) {
  Product product;
  AddCountersink(&product);
  AddHead(&product);
  AddCylinder(&product.parts[0], FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 1.6e-3, -5e-3,
              -1.6e-3);
  AddCylinder(&product.parts[1], FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.5e-3, -12e-3,
              -1.5e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, -0.2e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 2U);
  EXPECT_EQ(product.mates[0].kind, MateKind::kAxisHole);
  EXPECT_EQ(product.mates[1].kind, MateKind::kConeSeat);
  ASSERT_EQ(product.joints.size(), 1U);
  EXPECT_EQ(product.joints[0].free_translations, 0);
  EXPECT_EQ(product.joints[0].free_rotations, 1);
}

/** A socket that reaches from the pole below up to the polar angle, and a ball in it. */
Product MakeBallJoint(const Pose& X_WA, const Pose& X_AB, double ball_radius, double socket_end,
                      double ball_begin = 0) {
  Product product;
  Part* base = AddPart(&product, "base");
  AddCap(base, FeatureKind::kSocket, Vec3::Zero(), 10e-3, socket_end, std::numbers::pi);
  Part* ball = AddPart(&product, "ball");
  AddCap(ball, FeatureKind::kBall, Vec3(0, 0, 5e-3), ball_radius, ball_begin, std::numbers::pi);
  AddOccurrence(&product, product::PartId(0), X_WA);
  AddOccurrence(&product, product::PartId(1), X_WA * X_AB * Pose(Vec3(0, 0, -5e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(SphereSeat, ABallInItsSocketSeatsInAnyFrame) {
  Random random(7);
  for (int draw = 0; draw < 5; ++draw) {
    const Pose X_WA = RandomPose(&random, 1);
    const Product product = MakeBallJoint(X_WA, Pose(), 9.95e-3, std::numbers::pi / 2);
    ASSERT_EQ(product.mates.size(), 1U);
    const Mate& mate = product.mates[0];
    EXPECT_EQ(mate.kind, MateKind::kSphereSeat);
    EXPECT_DOUBLE_EQ(mate.hole_radius, 10e-3);
    EXPECT_DOUBLE_EQ(mate.shaft_radius, 9.95e-3);
    EXPECT_LT(((X_WA * mate.a.X_BM).p() - X_WA.p()).norm(), 1e-12);
    // The way out of half a sphere is its axis.
    EXPECT_LT(((X_WA * mate.a.X_BM).R().col(2) - X_WA.R().col(2)).norm(), 1e-9);
    // Half of the sphere, by 512 directions.
    EXPECT_NEAR(mate.overlap, 2 * std::numbers::pi * 9.95e-3 * 9.95e-3,
                0.01 * 4 * std::numbers::pi * 1e-4);
    ASSERT_EQ(product.joints.size(), 1U);
    EXPECT_EQ(product.joints[0].free_translations, 0);
    EXPECT_EQ(product.joints[0].free_rotations, 3);
  }
}

TEST(SphereSeat, OverlapFollowsTheSocketsReach) {
  for (const double polar : {0.25 * std::numbers::pi, 0.4 * std::numbers::pi,
                             0.6 * std::numbers::pi, 0.8 * std::numbers::pi}) {
    const Product product = MakeBallJoint(Pose(), Pose(), 10e-3, polar);
    ASSERT_EQ(product.mates.size(), 1U);
    const double cap = 2 * std::numbers::pi * 1e-4 * (std::cos(polar) + 1);  // Archimedes.
    EXPECT_NEAR(product.mates[0].overlap, cap, 0.01 * 4 * std::numbers::pi * 1e-4) << polar;
  }
}

TEST(SphereSeat, NoSeatWhereCentreSizeOrSideDiffer) {
  EXPECT_TRUE(
      MakeBallJoint(Pose(), Pose(Vec3(25e-6, 0, 0)), 10e-3, std::numbers::pi / 2).mates.empty());
  EXPECT_TRUE(MakeBallJoint(Pose(), Pose(), 6.9e-3, std::numbers::pi / 2).mates.empty());
  EXPECT_TRUE(MakeBallJoint(Pose(), Pose(), 10.2e-3, std::numbers::pi / 2).mates.empty());
  // A cap on top of the ball, and the socket below: concentric, but they do not face each other.
  Product product;
  AddCap(AddPart(&product, "base"), FeatureKind::kSocket, Vec3::Zero(), 10e-3,
         0.6 * std::numbers::pi, std::numbers::pi);
  AddCap(AddPart(&product, "lid"), FeatureKind::kBall, Vec3::Zero(), 10e-3, 0,
         0.4 * std::numbers::pi);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose());
  product.parts[0].box_B.Add(Vec3(0, 0, 10e-3));  // Their boxes meet.
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_TRUE(product.mates.empty());
}

}  // namespace
}  // namespace hvas::mates
