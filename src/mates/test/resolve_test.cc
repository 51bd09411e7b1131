#include "mates/resolve.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "spatial/test/random_pose.h"

namespace hvas::mates {
namespace {

using product::MateKind;
using spatial::RandomPose;

Pose DrawSmall(Random* random, double distance, double angle) {
  const auto draw = [&] {
    return Vec3(random->Uniform(-1, 1), random->Uniform(-1, 1), random->Uniform(-1, 1));
  };
  return {spatial::RotationFromVector(angle * draw()), distance * draw()};
}

/** A mate whose two connectors coincide when B is at X_WB. */
MateConstraint MakeMate(MateKind kind, const Pose& X_WB, const Vec3& p_B, const Vec3& zhat_B) {
  const Pose X_BN(spatial::FrameFromZ(zhat_B), p_B);
  const Quat flip = kind == MateKind::kFaceFace ? Quat(0, 1, 0, 0) : Quat::Identity();
  return {kind, X_WB * X_BN * Pose(flip, Vec3::Zero()), X_BN};
}

struct Case {
  const char* name;
  std::vector<std::pair<Vec3, Vec3>> axes;    // Point and direction in B.
  std::vector<std::pair<Vec3, Vec3>> planes;  // Point and normal in B.
  int translations;
  int rotations;
  std::vector<std::pair<Vec3, Vec3>> cones{};  // Point and axis in B.
  std::vector<Vec3> centres{};                 // In B.
};

std::vector<Case> MakeCases() {
  const Vec3 x = Vec3::UnitX();
  const Vec3 y = Vec3::UnitY();
  const Vec3 z = Vec3::UnitZ();
  const Vec3 o = Vec3::Zero();
  std::vector<Case> cases{
      {"nothing", {}, {}, 3, 3},
      {"axis", {{{0.01, 0.02, 0.03}, z}}, {}, 1, 1},
      {"plane", {}, {{{0.01, 0.02, 0.03}, z}}, 2, 1},
      {"two parallel axes", {{o, z}, {{0.04, 0, 0.01}, z}}, {}, 1, 0},
      {"axis and plane", {{o, z}}, {{{0.02, 0.01, -0.01}, -z}}, 0, 1},
      {"axis, plane and pin", {{o, z}, {{0.03, 0, 0}, z}}, {{{0.02, 0.01, -0.01}, -z}}, 0, 0},
      {"three planes of a corner", {}, {{o, x}, {o, y}, {o, z}}, 0, 0},
      {"two planes of an edge", {}, {{o, x}, {o, y}}, 1, 0},
      {"two parallel planes", {}, {{o, z}, {{0.1, 0, 0.02}, -z}}, 2, 1},
      {"axis and a plane along it", {{o, z}}, {{{0.02, 0, 0}, x}}, 1, 0},
      {"two axes square to each other that meet", {{o, z}, {o, x}}, {}, 0, 0},
      {"cone", {}, {}, 0, 1, {{{0.01, 0.02, 0.03}, z}}},
      {"cone and axis on it", {{{0, 0, 0.02}, z}}, {}, 0, 1, {{o, z}}},
      {"two parallel cones", {}, {}, 0, 0, {{o, z}, {{0.04, 0, 0.01}, z}}},
      {"ball", {}, {}, 0, 3, {}, {{0.01, 0.02, 0.03}}},
      {"two balls", {}, {}, 0, 1, {}, {o, {0.04, 0.01, 0.02}}},
      {"three balls", {}, {}, 0, 0, {}, {o, {0.04, 0, 0}, {0, 0.04, 0}}},
      {"ball and a plane through it", {}, {{o, z}}, 0, 1, {}, {o}},
      {"ball on an axis", {{o, z}}, {}, 0, 1, {}, {{0, 0, 0.02}}},
      {"ball beside an axis", {{o, z}}, {}, 0, 0, {}, {{0.03, 0, 0.02}}},
      {"22 axes and 16 planes, as of AS1's plate", {}, {}, 0, 0},
  };
  Case& many = cases.back();
  for (int i = 0; i < 22; ++i) {
    many.axes.push_back({Vec3(0.03 * (i % 5), 0.05 * (i / 5), 0.001 * i), z});
  }
  for (int i = 0; i < 16; ++i) {
    many.planes.push_back({Vec3(0.02 * i, 0.01 * i, i % 2 == 0 ? 0 : 0.02), i % 2 == 0 ? z : -z});
  }
  return cases;
}

std::vector<MateConstraint> MakeMates(const Case& c, const Pose& X_WB) {
  std::vector<MateConstraint> mates;
  for (const auto& [p_B, zhat_B] : c.axes) {
    mates.push_back(MakeMate(MateKind::kAxisHole, X_WB, p_B, zhat_B));
  }
  for (const auto& [p_B, zhat_B] : c.planes) {
    mates.push_back(MakeMate(MateKind::kFaceFace, X_WB, p_B, zhat_B));
  }
  for (const auto& [p_B, zhat_B] : c.cones) {
    mates.push_back(MakeMate(MateKind::kConeSeat, X_WB, p_B, zhat_B));
  }
  for (const Vec3& p_B : c.centres) {
    mates.push_back(MakeMate(MateKind::kSphereSeat, X_WB, p_B, Vec3(0.6, 0, 0.8)));
  }
  return mates;
}

// X9: the motions left are those of the textbook's joints.
TEST(CalcFreeTwists, CountsAreThoseOfTheJoints) {
  Random random(21);
  for (const Case& c : MakeCases()) {
    for (int draw = 0; draw < 20; ++draw) {
      const Pose X_WB = RandomPose(&random, 0.5);
      const FreeTwists free = CalcFreeTwists(MakeMates(c, X_WB), X_WB);
      EXPECT_EQ(free.translations, c.translations) << c.name;
      EXPECT_EQ(free.rotations, c.rotations) << c.name;
    }
  }
}

TEST(CalcFreeTwists, MovingAlongThemKeepsTheMatesToSecondOrder) {
  Random random(22);
  for (const Case& c : MakeCases()) {
    const Pose X_WB = RandomPose(&random, 0.5);
    const std::vector<MateConstraint> mates = MakeMates(c, X_WB);
    const FreeTwists free = CalcFreeTwists(mates, X_WB);
    for (int k = 0; k < free.count(); ++k) {
      const Twist& twist = free.basis[static_cast<std::size_t>(k)];
      const double coarse = CalcResidual(mates, spatial::Integrate(X_WB, twist, 1e-3));
      const double fine = CalcResidual(mates, spatial::Integrate(X_WB, twist, 1e-4));
      EXPECT_LT(coarse, 1e-3) << c.name;
      // Falls by 100 with a step a tenth as long, or is rounding.
      EXPECT_LT(fine, std::max(0.02 * coarse, 1e-12)) << c.name;
    }
  }
}

TEST(CalcFreeTwists, AxisLeavesSlidingAndTurningAboutIt) {
  Random random(23);
  const Pose X_WB = RandomPose(&random, 0.5);
  const Vec3 p_B(0.01, 0.02, 0.03);
  const MateConstraint mate = MakeMate(MateKind::kAxisHole, X_WB, p_B, Vec3::UnitX());
  const FreeTwists free = CalcFreeTwists({&mate, 1}, X_WB);
  ASSERT_EQ(free.count(), 2);
  const Vec3 axis_W = X_WB.q() * Vec3::UnitX();
  EXPECT_LT(free.basis[0].w.norm(), 1e-12);
  EXPECT_NEAR(std::abs(free.basis[0].v.dot(axis_W)), 1, 1e-12);
  EXPECT_LT(free.basis[1].w.cross(axis_W).norm(), 1e-9 * free.basis[1].w.norm());
  // The axis itself stays: velocity at its point is zero.
  const Vec3 v = free.basis[1].v + free.basis[1].w.cross(X_WB.q() * p_B);
  EXPECT_LT(v.norm(), 1e-9 * free.basis[1].w.norm());
}

// X9 from anywhere: within 1e-10 m, whatever the start.
TEST(Resolve, FulfilsEverySetFromRandomStarts) {
  Random random(31);
  for (const Case& c : MakeCases()) {
    for (int draw = 0; draw < 200; ++draw) {
      const Pose X_WB = RandomPose(&random, 0.5);
      const std::vector<MateConstraint> mates = MakeMates(c, X_WB);
      const Resolution near = Resolve(mates, X_WB * DrawSmall(&random, 5e-3, 0.17));
      EXPECT_TRUE(near.is_converged) << c.name << ' ' << near.residual;
      EXPECT_LE(near.iterations, 12) << c.name;
      const Resolution far = Resolve(mates, RandomPose(&random, 0.5));
      EXPECT_TRUE(far.is_converged) << c.name << " draw " << draw << ' ' << far.residual;
      if (c.translations + c.rotations == 0) {
        EXPECT_LT((near.X_WB.p() - X_WB.p()).norm(), 1e-9) << c.name;
        EXPECT_LT(spatial::RotationBetween(near.X_WB.q(), X_WB.q()).norm(), 1e-8) << c.name;
      }
    }
  }
}

TEST(Resolve, DoesNotDependOnTheWorldFrame) {
  Random random(32);
  for (const Case& c : MakeCases()) {
    const Pose X_WB = RandomPose(&random, 0.5);
    const Pose X_AW = RandomPose(&random, 0.5);
    const Pose X_WBStart = X_WB * DrawSmall(&random, 5e-3, 0.1);
    std::vector<MateConstraint> mates = MakeMates(c, X_WB);
    const Pose in_w = Resolve(mates, X_WBStart).X_WB;
    for (MateConstraint& mate : mates) {
      mate.X_WM = X_AW * mate.X_WM;
    }
    const Pose in_a = Resolve(mates, X_AW * X_WBStart).X_WB;
    EXPECT_LT((in_a.p() - (X_AW * in_w).p()).norm(), 1e-9) << c.name;
    EXPECT_LT(spatial::RotationBetween(in_a.q(), (X_AW * in_w).q()).norm(), 1e-8) << c.name;
  }
}

// For one axis the general solution is the paper's: X(3)..X(8), worked out here from the text.
TEST(Resolve, OneAxisEqualsThePapersClosedForm) {
  Random random(33);
  for (int draw = 0; draw < 200; ++draw) {
    const Pose X_WBStart = RandomPose(&random, 0.5);
    const MateConstraint mate =
        MakeMate(MateKind::kAxisHole, RandomPose(&random, 0.5), Vec3(0.01, -0.02, 0.03),
                 Vec3(0.3, 0.5, random.Uniform(-1, 1)).normalized());
    const Vec3 P_base = mate.X_WM.p();
    const Vec3 V_base = mate.X_WM.R().col(2);
    const Vec3 P_part = X_WBStart * mate.X_BN.p();             // X(3)
    const Vec3 V_part = X_WBStart.R() * mate.X_BN.R().col(2);  // X(5)
    const double alpha = std::acos(V_base.dot(V_part));        // X(7)
    const Vec3 u = V_part.cross(V_base).normalized();
    const Mat3 K = spatial::Skew(u);
    const Mat3 turn = Mat3::Identity() + std::sin(alpha) * K + (1 - std::cos(alpha)) * K * K;
    const Vec3 offset = P_base - P_part;
    const Vec3 shift = offset - V_base.dot(offset) * V_base;
    EXPECT_NEAR(shift.norm(), V_base.cross(P_part - P_base).norm(), 1e-12);  // X(8)
    const Vec3 p_paper = P_part + turn * (X_WBStart.p() - P_part) + shift;
    const Mat3 R_paper = turn * X_WBStart.R();
    for (const Pose& X_WB : {Resolve({&mate, 1}, X_WBStart).X_WB, AlignToAxis(mate, X_WBStart)}) {
      EXPECT_LT((X_WB.p() - p_paper).norm(), 1e-7);
      EXPECT_LT((X_WB.R() - R_paper).norm(), 1e-7);
    }
  }
}

TEST(Resolve, ParallelAndOpposedAxesAreLegal) {
  const MateConstraint mate{MateKind::kAxisHole, Pose(), Pose()};
  const Resolution parallel = Resolve({&mate, 1}, Pose(Vec3(1e-3, 0, 5e-3)));
  EXPECT_TRUE(parallel.is_converged);
  EXPECT_LT((parallel.X_WB.p() - Vec3(0, 0, 5e-3)).norm(), 1e-12);
  const Resolution opposed = Resolve({&mate, 1}, Pose(Quat(0, 1, 0, 0), Vec3(1e-3, 0, 5e-3)));
  EXPECT_TRUE(opposed.is_converged);
  EXPECT_LT((opposed.X_WB.R().col(2) - Vec3::UnitZ()).norm(), 1e-9);
}

TEST(Resolve, ContradictionIsReportedAndLeavesTheBestCompromise) {
  const std::vector<MateConstraint> mates{
      {MateKind::kAxisHole, Pose(Vec3(0, 0, 0)), Pose()},
      {MateKind::kAxisHole, Pose(Vec3(0.05002, 0, 0)), Pose(Vec3(0.05, 0, 0))}};
  const Resolution result = Resolve(mates, Pose(Vec3(1e-3, 2e-3, 0)));
  EXPECT_FALSE(result.is_converged);
  EXPECT_LT((result.X_WB.p() - Vec3(10e-6, 0, 0)).norm(), 1e-9);  // Half of 20 um on each.
}

TEST(ResolveToward, ReachesTheGoalWhereTheMatesAllowAndIsNearestOtherwise) {
  Random random(41);
  for (const Case& c : MakeCases()) {
    for (int draw = 0; draw < 50; ++draw) {
      const Pose X_WB = RandomPose(&random, 0.5);
      const std::vector<MateConstraint> mates = MakeMates(c, X_WB);
      const Pose X_WBStart = X_WB * DrawSmall(&random, 5e-3, 0.17);
      const Resolution exact = ResolveToward(mates, X_WBStart, X_WB);
      EXPECT_TRUE(exact.is_converged) << c.name;
      EXPECT_LT((exact.X_WB.p() - X_WB.p()).norm(), 1e-8) << c.name;
      EXPECT_LT(spatial::RotationBetween(exact.X_WB.q(), X_WB.q()).norm(), 1e-7) << c.name;
      // A goal beside the mates: no free motion brings it nearer, to first order.
      const Pose X_WBGoal = X_WB * DrawSmall(&random, 0.02, 0.3);
      const Resolution result = ResolveToward(mates, X_WBStart, X_WBGoal);
      EXPECT_TRUE(result.is_converged) << c.name << ' ' << result.residual;
      const FreeTwists free = CalcFreeTwists(mates, result.X_WB);
      const Vec3 turn = spatial::RotationBetween(result.X_WB.q(), X_WBGoal.q());
      const Vec3 p_BR = result.X_WB.Inverse() * free.p_WR;
      const Vec3 shift = X_WBGoal * p_BR - free.p_WR;
      for (int k = 0; k < free.count(); ++k) {
        const Twist& twist = free.basis[static_cast<std::size_t>(k)];
        const Vec3 v_R = twist.v + twist.w.cross(free.p_WR - result.X_WB.p());
        const double gain = free.length * free.length * twist.w.dot(turn) + v_R.dot(shift);
        EXPECT_NEAR(gain, 0, 1e-9) << c.name;
      }
    }
  }
}

TEST(MakeConstraint, TakesThePlacedSideIntoTheWorld) {
  Random random(51);
  product::Mate mate;
  mate.kind = MateKind::kAxisHole;
  mate.a = {product::OccurrenceId(0), product::FeatureId(0), RandomPose(&random, 0.5)};
  mate.b = {product::OccurrenceId(1), product::FeatureId(0), RandomPose(&random, 0.5)};
  const Pose X_WP = RandomPose(&random, 0.5);
  const MateConstraint holds_b = MakeConstraint(mate, product::OccurrenceId(1), X_WP);
  EXPECT_LT((holds_b.X_WM.p() - (X_WP * mate.a.X_BM).p()).norm(), 1e-15);
  EXPECT_LT((holds_b.X_BN.p() - mate.b.X_BM.p()).norm(), 1e-15);
  const MateConstraint holds_a = MakeConstraint(mate, product::OccurrenceId(0), X_WP);
  EXPECT_LT((holds_a.X_WM.p() - (X_WP * mate.b.X_BM).p()).norm(), 1e-15);
  EXPECT_LT((holds_a.X_BN.p() - mate.a.X_BM.p()).norm(), 1e-15);
}

}  // namespace
}  // namespace hvas::mates
