#include "paths/swept_volume.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/mesh.h"
#include "contact/test/parts.h"
#include "paths/test/mesh_checks.h"

namespace hvas::paths {
namespace {

using contact::ShapeSource;
using spatial::Pose;

SweptVolume MustSweep(const ShapeSource& part, const Path& path, double resolution) {
  SweepOptions options;
  options.resolution = resolution;
  auto swept = Sweep(part, path, options);
  EXPECT_TRUE(swept) << swept.error().ToString();
  EXPECT_TRUE(testing::IsClosed(swept->mesh));
  return std::move(*swept);
}

/** How the error of the volume, as a fraction, falls when the resolution is halved: 2 means with
 its square. */
struct Convergence {
  double coarse{0};
  double fine{0};

  [[nodiscard]] double order() const { return std::log2(coarse / fine); }
};

Convergence Converge(const ShapeSource& part, const Path& path, double volume, double resolution) {
  const auto error_at = [&](double h) {
    return std::abs(MustSweep(part, path, h).volume - volume) / volume;
  };
  return {error_at(resolution), error_at(0.5 * resolution)};
}

// Volumes against closed forms, and how they converge.

TEST(SweptVolumeTest, X13BlockMovedAlongItsEdgeIsALongerBlock) {  // translation
  const Vec3 half(0.01, 0.015, 0.02);
  const Path path = MakeTranslation(Pose(Vec3(0.1, 0, 0)), Vec3(0, 0, 0.06));
  const double volume = 0.02 * 0.03 * (0.04 + 0.06);
  const Convergence error = Converge(contact::testing::Block(half), path, volume, 2e-3);
  EXPECT_LT(error.fine, 0.005);
  EXPECT_GT(error.order(), 1.5);
}

TEST(SweptVolumeTest, X13BlockMovedAcrossIsAPrism) {  // no steps along the slanted sides
  const Vec3 half(0.01, 0.015, 0.02);
  const Vec3 d(0.03, 0.02, 0.05);
  const Pose X_WB(spatial::RotationFromVector(Vec3(0.3, -0.2, 0.5)), Vec3(0, 0.1, 0));
  const Path path = MakeTranslation(X_WB, X_WB.q() * d);
  const Vec3 size = 2 * half;
  const double volume = size.prod() + d.x() * size.y() * size.z() + d.y() * size.z() * size.x() +
                        d.z() * size.x() * size.y();
  const Convergence error = Converge(contact::testing::Block(half), path, volume, 2e-3);
  EXPECT_LT(error.fine, 0.005);
  EXPECT_GT(error.order(), 1.5);
}

TEST(SweptVolumeTest, BallMovedStraightIsACapsule) {
  constexpr double kRadius = 0.01;
  constexpr double kWay = 0.03;
  const Path path = MakeTranslation(Pose(), Vec3(0.6, 0, 0.8) * kWay);
  const double volume = std::numbers::pi * kRadius * kRadius * (kWay + 4.0 / 3 * kRadius);
  const SweptVolume capsule = MustSweep(contact::testing::Ball(kRadius, 1e-5), path, 1e-3);
  EXPECT_NEAR(capsule.volume / volume, 1, 0.005);  // of which the ball's facets are 0.002
  EXPECT_EQ(testing::CalcEuler(capsule.mesh), 2);
}

/** About the z axis, of a shaft along z that stands at x = 30 mm. */
Path TurnAboutZ(double angle) {
  return MakeRotation(Pose(Vec3(0.03, 0, 0)), Vec3::Zero(), Vec3::UnitZ(), angle);
}

TEST(SweptVolumeTest, X13ShaftTurnedAboutAParallelAxisFollowsPappus) {  // rotation about an axis
  constexpr double kRadius = 0.008;
  constexpr double kLength = 0.02;
  constexpr double kAngle = 1.5 * std::numbers::pi;
  const double area = kAngle * 0.03 * 2 * kRadius + std::numbers::pi * kRadius * kRadius;
  const Convergence error =
      Converge(contact::testing::Shaft(kRadius, kLength), TurnAboutZ(kAngle), area * kLength, 2e-3);
  EXPECT_LT(error.fine, 0.005);
  EXPECT_GT(error.order(), 1.5);
}

TEST(SweptVolumeTest, WholeTurnIsARingWithAHole) {
  const SweptVolume ring =
      MustSweep(contact::testing::Shaft(0.008, 0.02), TurnAboutZ(2 * std::numbers::pi), 1e-3);
  EXPECT_EQ(testing::CalcEuler(ring.mesh), 0);
  const double volume = 2 * std::numbers::pi * 0.03 * 0.016 * 0.02;  // Pappus
  EXPECT_NEAR(ring.volume / volume, 1, 0.01);
}

TEST(SweptVolumeTest, BlockTurnedAboutItsOwnAxisIsACylinder) {
  const Path path = MakeRotation(Pose(), Vec3::Zero(), Vec3::UnitZ(), std::numbers::pi);
  const Vec3 half(0.012, 0.009, 0.01);
  const double volume = std::numbers::pi * (0.012 * 0.012 + 0.009 * 0.009) * 0.02;
  const Convergence error = Converge(contact::testing::Block(half), path, volume, 1e-3);
  EXPECT_LT(error.fine, 0.005);
  EXPECT_GT(error.order(), 1.5);
}

TEST(SweptVolumeTest, PartThatDoesNotMoveSweepsItself) {
  const SweptVolume itself = MustSweep(contact::testing::Bushing(0.01, 0.02, 0.03), {Pose()}, 1e-3);
  EXPECT_EQ(testing::CalcEuler(itself.mesh), 0);  // with its bore
  EXPECT_NEAR(itself.volume / (std::numbers::pi * (4e-4 - 1e-4) * 0.03), 1, 0.01);
}

TEST(SweptVolumeTest, SteppedPartSweepsNothingBesideIt) {  // one piece, within the part's box
  const ShapeSource part = contact::testing::GroovedShaft(0.02, 0.06, 1e-5);
  const SweptVolume itself = MustSweep(part, {Pose()}, 1e-3);
  EXPECT_EQ(testing::CalcEuler(itself.mesh), 2);
  const Vec3 half(0.02, 0.02, 0.03);
  for (const Vec3& vertex : itself.mesh.vertices) {
    const Vec3 beyond = (vertex - Vec3(0, 0, 0.03)).cwiseAbs() - half;
    EXPECT_LT(beyond.maxCoeff(), itself.error);
  }
}

// What holds for any path.

Path DrawPath(Random* random) {
  Path path;
  Vec3 turn = Vec3::Zero();
  Vec3 p = Vec3::Zero();
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      turn[axis] += random->Uniform(-0.4, 0.4);
      p[axis] += random->Uniform(-0.015, 0.015);
    }
    path.emplace_back(spatial::RotationFromVector(turn), p);
  }
  return path;
}

TEST(SweptVolumeTest, EveryPointOfThePartIsInsideAtEveryTime) {
  Random random(11);
  const ShapeSource part = contact::testing::Cup(0.006, 0.012, 0.006, 0.02);
  const contact::Mesh solid = contact::MakeMesh(part, Vec3::Zero());
  for (int draw = 0; draw < 3; ++draw) {
    const Path path = DrawPath(&random);
    const SweptVolume swept = MustSweep(part, path, 1e-3);
    ShapeSource source{swept.mesh.vertices, swept.mesh.triangles, {}, {}};
    source.triangle_face.resize(source.triangles.size());
    source.faces.resize(1);
    const contact::Mesh mesh = contact::MakeMesh(source, Vec3::Zero());
    int tried = 0;
    while (tried < 60) {
      const Vec3 p_BQ(random.Uniform(-0.012, 0.012), random.Uniform(-0.012, 0.012),
                      random.Uniform(0, 0.02));
      // Inside by more than the error of the volume.
      const double rim = 0.012 - std::hypot(p_BQ.x(), p_BQ.y());
      const double floor = std::min(p_BQ.z(), 0.006 - p_BQ.z());
      if (std::min(rim, floor) < swept.error) {
        continue;
      }
      ++tried;
      const std::size_t i = static_cast<std::size_t>(random.Uniform(0, 7));
      const Pose X_WB = Interpolate(path[i], path[i + 1], random.Uniform());
      EXPECT_NEAR(mesh.CalcWindingNumber(X_WB * p_BQ), 1, 1e-3);
    }
    // And nothing is inside where the part never comes.
    for (std::size_t n = 0; n < swept.mesh.vertices.size(); n += 11) {
      const Vec3& vertex = swept.mesh.vertices[n];
      double least = 1;
      for (const Pose& X_WB :
           Resample(path, {Vec3(-0.012, -0.012, 0), Vec3(0.012, 0.012, 0.02)}, 2e-3)) {
        const Vec3 p = X_WB.Inverse() * vertex;
        const double outside = std::hypot(std::max(std::hypot(p.x(), p.y()) - 0.012, 0.0),
                                          std::max({-p.z(), p.z() - 0.02, 0.0}));
        least = std::min(least, outside);
      }
      EXPECT_LT(least, swept.error + 2e-3);
    }
  }
}

TEST(SweptVolumeTest, ThreadsAreNoMatter) {
  Random random(12);
  const ShapeSource part = contact::testing::Shaft(0.005, 0.02);
  const Path path = DrawPath(&random);
  SweepOptions options;
  options.resolution = 2e-3;
  options.threads = 1;
  const auto one = Sweep(part, path, options);
  options.threads = 3;
  const auto three = Sweep(part, path, options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->mesh.vertices, three->mesh.vertices);
  EXPECT_EQ(one->mesh.triangles, three->mesh.triangles);
}

TEST(SweptVolumeTest, ResolutionIsChosenFromTheExtent) {
  SweepOptions options;
  const auto swept = Sweep(contact::testing::Shaft(0.005, 0.02),
                           MakeTranslation(Pose(), Vec3(0.08, 0, 0)), options);
  ASSERT_TRUE(swept);
  EXPECT_NEAR(swept->resolution, 0.9e-3, 1e-12);  // a hundredth of 90 mm
}

TEST(SweptVolumeTest, X13AThinWallIsResolvedWhereTheGridHasRoomForIt) {
  // A sheet of 0.8 mm goes 2 mm along its normal, beside one that goes far.
  const ShapeSource sheet = contact::testing::Block(Vec3(0.02, 0.0004, 0.02));
  const Path across = MakeTranslation(Pose(), Vec3(0.002, 0, 0));
  SweepOptions options;
  options.thinnest_wall = 0.8e-3;
  const auto swept = Sweep(sheet, across, options);
  ASSERT_TRUE(swept);
  EXPECT_LE(2 * swept->error, 0.8e-3 * (1 + 1e-9));
  EXPECT_TRUE(testing::IsClosed(swept->mesh));
  EXPECT_NEAR(swept->volume, 0.042 * 0.0008 * 0.04, 0.01 * 0.042 * 0.0008 * 0.04);
  options.thinnest_wall = 1e-6;  // finer than there is room for
  const auto coarse = Sweep(sheet, across, options);
  ASSERT_TRUE(coarse);
  EXPECT_GT(2 * coarse->error, 1e-6);
}

// What cannot be done.

TEST(SweptVolumeTest, WhatCannotBeSweptIsAnErrorThatSaysWhatToDo) {
  const ShapeSource part = contact::testing::Block(Vec3::Constant(0.01));
  const Path path = MakeTranslation(Pose(), Vec3(0.1, 0.1, 0.1));
  SweepOptions options;
  EXPECT_EQ(Sweep({}, path, options).error().code, ErrorCode::kInvalid);
  EXPECT_EQ(Sweep(part, {}, options).error().code, ErrorCode::kInvalid);
  EXPECT_EQ(Sweep(part, {Pose(Vec3(0, NAN, 0))}, options).error().code, ErrorCode::kInvalid);
  options.resolution = -1;
  EXPECT_EQ(Sweep(part, path, options).error().code, ErrorCode::kInvalid);
  options.resolution = 1e-5;
  const auto too_fine = Sweep(part, path, options);
  ASSERT_FALSE(too_fine);
  EXPECT_EQ(too_fine.error().code, ErrorCode::kOutOfResource);
  EXPECT_EQ(too_fine.error().remedy, "choose 0.49 mm or more");
  options.resolution = 1e-3;
  std::stop_source stop;
  stop.request_stop();
  options.stop = stop.get_token();
  EXPECT_EQ(Sweep(part, path, options).error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace hvas::paths
