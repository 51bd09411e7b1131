// Least distances along a path, against closed forms.

#include "paths/clearance.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/test/parts.h"

namespace hvas::paths {
namespace {

using contact::Shape;
using contact::ShapeSource;
using spatial::Pose;

constexpr double kMicrometre = 1e-6;

std::shared_ptr<const Shape> Build(const ShapeSource& source) {
  return *Shape::Build(source, {});
}

Path Fine(const Path& path, const Shape& part, double step) {
  return Resample(path, part.box_B(), step);
}

TEST(ClearanceTest, X13ShaftThatPassesABlockAndAPlateHasTheClosedFormsClearances) {
  const auto shaft = Build(contact::testing::Shaft(3e-3, 20e-3));
  const auto block = Build(contact::testing::Block({10e-3, 10e-3, 10e-3}));
  // Along z past the block, 1.25 mm beside its face; it ends 0.7 mm above the plate.
  const Path path =
      Fine(MakeTranslation(Pose(Vec3(14.25e-3, 0, 60e-3)), Vec3(0, 0, -90e-3)), *shaft, 0.1e-3);
  const double end = path.back().p().z() + shaft->box_B().low.z();
  const std::vector<Neighbour> neighbours{{block.get(), Pose(Vec3(-1, 0, 0))},
                                          {block.get(), Pose()},
                                          {block.get(), Pose(Vec3(14e-3, 0, end - 10.7e-3))}};
  ClearanceOptions options;
  options.count = 2;
  const auto found = CalcClearances(*shaft, path, neighbours, options);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  EXPECT_EQ((*found)[0].neighbour, 2U);
  EXPECT_NEAR((*found)[0].distance, 0.7e-3, kMicrometre);
  EXPECT_EQ((*found)[0].pose, path.size() - 1);
  EXPECT_NEAR((*found)[0].nhat_W.z(), 1, 1e-6);
  EXPECT_EQ((*found)[1].neighbour, 1U);
  EXPECT_NEAR((*found)[1].distance, 1.25e-3, kMicrometre);
  EXPECT_NEAR((*found)[1].nhat_W.x(), 1, 1e-6);
}

TEST(ClearanceTest, X13CornerOfATurningBlockComesAsNearAsItsDiagonalSays) {
  const auto block = Build(contact::testing::Block({10e-3, 10e-3, 10e-3}));
  const double diagonal = 10e-3 * std::numbers::sqrt2;
  const Pose X_WN(Vec3(diagonal + 0.3e-3 + 10e-3, 0, 0));  // its face is 0.3 mm beyond the corner
  constexpr double kStep = 20e-6;
  const Path path = Fine(MakeRotation(Pose(), Vec3::Zero(), Vec3::UnitZ(), 0.5 * std::numbers::pi),
                         *block, kStep);
  const auto found = CalcClearances(*block, path, {{block.get(), X_WN}}, {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U);
  EXPECT_GE(found->front().distance, 0.3e-3 - kMicrometre);
  EXPECT_LE(found->front().distance, 0.3e-3 + 0.5 * kStep);
  EXPECT_NEAR(static_cast<double>(found->front().pose) / static_cast<double>(path.size() - 1), 0.5,
              0.01);  // at 45 degrees
}

TEST(ClearanceTest, X13OverlapIsNegativeByItsDepth) {
  const auto shaft = Build(contact::testing::Shaft(3e-3, 20e-3));
  const auto block = Build(contact::testing::Block({10e-3, 10e-3, 10e-3}));
  const Path path =
      Fine(MakeTranslation(Pose(Vec3(12.96e-3, 0, 60e-3)), Vec3(0, 0, -60e-3)), *shaft, 0.1e-3);
  const auto found = CalcClearances(*shaft, path, {{block.get(), Pose()}}, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->front().distance, -40e-6, kMicrometre);
}

TEST(ClearanceTest, SkippedPosesAreNeverTheNearest) {  // as if each pose were measured
  const auto shaft = Build(contact::testing::Shaft(2e-3, 15e-3));
  const auto block = Build(contact::testing::Block({8e-3, 5e-3, 6e-3}));
  Random random(7);
  const auto vary = [&](double scale) {
    return Vec3(scale * random.Normal(), scale * random.Normal(), scale * random.Normal());
  };
  for (int round = 0; round < 10; ++round) {
    Path path;
    for (int i = 0; i < 5; ++i) {
      path.emplace_back(spatial::RotationFromVector(vary(1)), vary(25e-3));
    }
    path = Fine(path, *shaft, 0.5e-3);
    const std::vector<Neighbour> neighbours{{block.get(), Pose()}};
    const auto found = CalcClearances(*shaft, path, neighbours, {});
    double least = 1;
    for (const Pose& X_WB : path) {
      least = std::min(least, CalcClearances(*shaft, {X_WB}, neighbours, {})->front().distance);
    }
    EXPECT_NEAR(found->front().distance, least, 1e-9) << "round " << round;
  }
}

TEST(ClearanceTest, PathWithoutAPoseIsRefusedAndAStopEndsIt) {
  const auto block = Build(contact::testing::Block({8e-3, 5e-3, 6e-3}));
  EXPECT_EQ(CalcClearances(*block, {}, {}, {}).error().code, ErrorCode::kInvalid);
  std::stop_source stop;
  stop.request_stop();
  ClearanceOptions options;
  options.stop = stop.get_token();
  EXPECT_EQ(CalcClearances(*block, {Pose()}, {{block.get(), Pose()}}, options).error().code,
            ErrorCode::kCancelled);
}

}  // namespace
}  // namespace hvas::paths
