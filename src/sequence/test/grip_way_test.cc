// The way of a grip along poses.

#include "sequence/grip_way.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::sequence {
namespace {

using spatial::Pose;

constexpr double kGyration = 20e-3;   // [m]
constexpr double kArcRadius = 50e-3;  // Radius of the arc [m].

/** A quarter of a circle about the origin, on which the grip turns with it, then straight along y.
 */
GripWay MakeWay(int pieces = 90) {
  std::vector<Pose> poses;
  for (int i = 0; i <= pieces; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / pieces;
    const Quat q(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    poses.emplace_back(q, q * Vec3(0, -kArcRadius, 0));
  }
  poses.emplace_back(poses.back().q(), poses.back().p() + Vec3(0, 10e-3, 0));
  return {poses, kGyration};
}

TEST(GripWayTest, TravelCountsDistanceAndTurn) {
  EXPECT_NEAR(MakeWay().length(),
              0.5 * std::numbers::pi * std::hypot(kArcRadius, kGyration) + 10e-3, 1e-5);
}

TEST(GripWayTest, ItBeginsAtTheGoalAndEndsStraight) {
  const GripWay way = MakeWay();
  EXPECT_LT((way.At(0).p() - Vec3(0, -kArcRadius, 0)).norm(), 1e-12);
  EXPECT_LT((way.outward_W() - Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((way.At(way.length() + 30e-3).p() - Vec3(kArcRadius, 40e-3, 0)).norm(), 1e-9);
  EXPECT_LT((way.RateAt(way.length() + 1).v - Vec3::UnitY()).norm(), 1e-9);
}

TEST(GripWayTest, ATravelIsFoundAgainFromItsPose) {
  const GripWay way = MakeWay();
  for (double travel = 0; travel < way.length() + 20e-3; travel += 3.7e-3) {
    for (const double off : {-4e-3, 0.0, 6e-3}) {
      EXPECT_NEAR(way.CalcTravel(way.At(travel), travel + off), travel, 1e-5)
          << travel << " " << off;
    }
  }
}

TEST(GripWayTest, AcrossTheWayIsNoTravel) {
  const GripWay way = MakeWay();
  const double travel = 0.3 * way.length();
  const Pose X = way.At(travel);
  const Vec3 across = X.p().normalized();
  EXPECT_NEAR(way.CalcTravel({X.q(), X.p() + 0.5e-3 * across}, travel), travel, 2e-5);
}

TEST(GripWayTest, AtACornerTheNearestPieceIsFound) {
  const GripWay way({Pose(), Pose(Vec3(0, 0, 30e-3)), Pose(Vec3(40e-3, 0, 30e-3))}, kGyration);
  // Beyond the corner, along the outer piece and along the inner one.
  for (const double near : {25e-3, 30e-3, 33e-3}) {
    EXPECT_NEAR(way.CalcTravel(Pose(Vec3(-2e-3, 0, 30e-3)), near), 30e-3, 1e-12) << near;
    EXPECT_NEAR(way.CalcTravel(Pose(Vec3(-2e-3, 0, 28e-3)), near), 28e-3, 1e-12) << near;
    EXPECT_NEAR(way.CalcTravel(Pose(Vec3(5e-3, 0, 31e-3)), near), 35e-3, 1e-12) << near;
  }
}

TEST(GripWayTest, TheSharpestBendIsThatOfTheCornerWithinReach) {
  const GripWay way({Pose(), Pose(Vec3(0, 0, 30e-3)), Pose(Vec3(40e-3, 0, 30e-3))}, kGyration);
  EXPECT_NEAR(way.CalcSharpestBend(33e-3, -5e-3), std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(way.CalcSharpestBend(28e-3, 5e-3), std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(way.CalcSharpestBend(36e-3, -5e-3), 0, 1e-12);
  EXPECT_NEAR(way.CalcSharpestBend(80e-3, 5e-3), 0, 1e-12);
}

TEST(GripWayTest, SpeedIsThatOfTheTravel) {
  const GripWay way = MakeWay();
  const double travel = 0.4 * way.length();
  const double step = 0.1e-3;
  const Pose from = way.At(travel);
  const Pose to = way.At(travel + step);
  const spatial::Twist moved{spatial::RotationBetween(from.q(), to.q()), to.p() - from.p()};
  EXPECT_NEAR(way.CalcSpeed(moved, travel), step, 1e-9);
}

}  // namespace
}  // namespace hvas::sequence
