#include "paths/path.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::paths {
namespace {

using spatial::Box;
using spatial::Pose;

Vec3 DrawVector(Random* random, double size) {
  return {random->Uniform(-size, size), random->Uniform(-size, size), random->Uniform(-size, size)};
}

Pose DrawPose(Random* random) {
  return {spatial::RotationFromVector(DrawVector(random, 1.5)), DrawVector(random, 0.3)};
}

TEST(PathTest, InterpolationBeginsAndEndsWhereItIsToldTo) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Pose from = DrawPose(&random);
    const Pose to = DrawPose(&random);
    const Vec3 p_BQ = DrawVector(&random, 0.1);
    EXPECT_LT((Interpolate(from, to, 0) * p_BQ - from * p_BQ).norm(), 1e-12);
    EXPECT_LT((Interpolate(from, to, 1) * p_BQ - to * p_BQ).norm(), 1e-12);
  }
}

TEST(PathTest, ScrewIsTheSameSeenFromAnywhere) {  // frame invariance
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose from = DrawPose(&random);
    const Pose to = DrawPose(&random);
    const Pose X_AW = DrawPose(&random);
    const Pose X_BC = DrawPose(&random);
    const Pose seen = X_AW * Interpolate(from, to, 0.3) * X_BC;
    const Pose itself = Interpolate(X_AW * from * X_BC, X_AW * to * X_BC, 0.3);
    EXPECT_LT((seen.p() - itself.p()).norm(), 1e-12);
    EXPECT_LT(spatial::RotationBetween(seen.q(), itself.q()).norm(), 1e-12);
  }
}

TEST(PathTest, X13RotationKeepsEveryPointAtItsDistanceFromTheAxis) {  // about an axis
  const Vec3 p_WQ(0.1, 0.2, 0);
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  const Pose X_WB(Quat(0.8, 0.6, 0, 0), Vec3(0.05, 0, 0.1));
  const Path path = MakeRotation(X_WB, p_WQ, axis, 1.75 * std::numbers::pi);
  const Path fine = Resample(path, Box{Vec3::Zero(), Vec3::Constant(0.02)}, 1e-3);
  const auto distance_of = [&](const Pose& pose) { return axis.cross(pose.p() - p_WQ).norm(); };
  for (const Pose& pose : fine) {
    EXPECT_NEAR(distance_of(pose), distance_of(X_WB), 1e-12);
  }
  const Vec3 end =
      p_WQ + spatial::RotationFromVector(Vec3(1.75 * std::numbers::pi * axis)) * (X_WB.p() - p_WQ);
  EXPECT_LT((fine.back().p() - end).norm(), 1e-12);
  EXPECT_NEAR(CalcLength(fine, Vec3::Zero()), 1.75 * std::numbers::pi * distance_of(X_WB), 1e-5);
}

TEST(PathTest, StepsMoveNoPointFurtherThanAsked) {
  Random random(3);
  const Box box_B{Vec3(-0.02, -0.01, 0), Vec3(0.03, 0.04, 0.1)};
  for (const double step : {1e-3, 3e-3}) {
    const Path fine =
        Resample({DrawPose(&random), DrawPose(&random), DrawPose(&random)}, box_B, step);
    ASSERT_GT(fine.size(), 50u);
    for (std::size_t i = 1; i < fine.size(); ++i) {
      for (int k = 0; k < 20; ++k) {
        const Vec3 p_BQ(random.Uniform(-0.02, 0.03), random.Uniform(-0.01, 0.04),
                        random.Uniform(0, 0.1));
        EXPECT_LT((fine[i] * p_BQ - fine[i - 1] * p_BQ).norm(), step * (1 + 1e-9));
      }
    }
  }
}

TEST(PathTest, RestingPartsNeedFewPoses) {
  const Pose rest(Vec3(0.1, 0, 0));
  Path path(10'000, rest);
  path.push_back(Pose(Vec3(0.1, 0, 0.0101)));
  const Path fine = Resample(path, Box{Vec3::Zero(), Vec3::Constant(0.01)}, 1e-3);
  EXPECT_EQ(fine.size(), 12u);  // where it rests, and eleven steps
  EXPECT_EQ(fine.back().p(), path.back().p());
}

}  // namespace
}  // namespace hvas::paths
