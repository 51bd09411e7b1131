#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "paths/check_way.h"
#include "paths/path.h"
#include "paths/test/pairs.h"
#include "paths/way.h"

namespace hvas::paths {
namespace {

using spatial::Pose;
using testing::Pair;

// A frame that agrees with no axis.
Pose Askew(int number) {
  const Vec3 turn = Vec3(0.3, -0.7, 0.5) * (1.0 + 0.61 * number);
  return {spatial::RotationFromVector(turn), Vec3(0.02, -0.05 * number, 0.03)};
}

// What FindWay() is asked: the pair somewhere in space.
struct Placed {
  contact::Scene scene;
  WayProblem problem;

  Placed(const Pair& pair, const Pose& X_WA) {
    (void)scene.Add(pair.around, X_WA);
    problem.scene = &scene;
    problem.part = pair.part;
    problem.X_WB_start = X_WA * pair.X_AB;
    problem.tolerance = pair.tolerance;
  }
};

// The least distance along a way at poses that are `step` apart, by queries of its own [m].
double MeasureDensely(const WayProblem& problem, const Path& path, double step) {
  contact::QueryWorkspace workspace;
  contact::QueryOptions options;
  options.margin = 0;
  double least = 0;
  for (const Pose& X_WB : Resample(path, problem.part->box_B(), step)) {
    problem.scene->Query(*problem.part, X_WB, options, &workspace);
    least = std::min(least, workspace.deepest());
  }
  return least;
}

bool IsOut(const WayProblem& problem, const Pose& X_WB) {
  const contact::BodyId around(0);
  const auto box =
      spatial::Transform(problem.scene->pose(around), problem.scene->shape(around).box_B());
  return !box.Overlaps(spatial::Transform(X_WB, problem.part->box_B()));
}

WaySearch Find(const WayProblem& problem, std::uint64_t seed, std::uint64_t budget) {
  WayOptions options;
  options.seed = seed;
  options.budget = budget;
  const auto start = std::chrono::steady_clock::now();
  auto found = FindWay(problem, options);
  if (!found) {
    ADD_FAILURE() << found.error().ToString();
    return {};
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cout << "  " << seconds << " s, " << found->queries << " queries, "
            << (found->way ? NameOf(found->way->method) : "none")
            << (found->way ? ", poses " + std::to_string(found->way->path.size()) : "") << "\n";
  return *std::move(found);
}

void ExpectWay(const Pair& pair, std::uint64_t budget) {
  SCOPED_TRACE(pair.name);
  std::cout << pair.name << "\n";
  for (int frame = 0; frame < 2; ++frame) {
    const Placed placed(pair, frame == 0 ? Pose() : Askew(frame));
    const WaySearch found = Find(placed.problem, 3, budget);
    ASSERT_TRUE(found.way.has_value()) << "frame " << frame << ", to go " << found.distance_to_go;
    const Path& path = found.way->path;
    EXPECT_EQ((path.front().p() - placed.problem.X_WB_start.p()).norm(), 0);
    EXPECT_TRUE(IsOut(placed.problem, path.back()));
    const double step = CheckStepOf(placed.problem.tolerance);
    EXPECT_GE(MeasureDensely(placed.problem, path, step), -placed.problem.tolerance - 0.5 * step);
  }
}

TEST(FindWayTest, BlockGoesThroughASteppedChannel) {
  ExpectWay(testing::MakeZigZag(50e-6), 400'000);
}

TEST(FindWayTest, HookComesOutAroundACorner) {
  ExpectWay(testing::MakeHook(50e-6), 400'000);
}

TEST(FindWayTest, BayonetTurnsBeforeItGoesOut) {
  ExpectWay(testing::MakeBayonet(50e-6), 400'000);
}

TEST(FindWayTest, APartOnAnAxisTurnsAboutItAndGoesAlongItAlone) {
  for (int frame = 0; frame < 3; ++frame) {
    const Pose X_WA = frame == 0 ? Pose() : Askew(frame);
    Placed placed(testing::MakeBayonet(200e-6), X_WA);
    const ScrewAxis axis{X_WA.p(), X_WA.R().col(2), 0};
    placed.problem.axes = {axis};
    const WaySearch found = Find(placed.problem, 1, 400'000);
    ASSERT_TRUE(found.way.has_value());
    for (const Pose& X_WB : found.way->path) {
      const Pose X_moved = X_WB * placed.problem.X_WB_start.Inverse();
      const Vec3 gone = X_moved * axis.p_WQ - axis.p_WQ;
      EXPECT_LT((X_moved.q() * axis.axis_W).cross(axis.axis_W).norm(), 1e-9);
      EXPECT_LT(gone.cross(axis.axis_W).norm(), 1e-9);
    }
    const double step = CheckStepOf(placed.problem.tolerance);
    EXPECT_GE(MeasureDensely(placed.problem, found.way->path, step),
              -placed.problem.tolerance - 0.5 * step);
    EXPECT_TRUE(IsOut(placed.problem, found.way->path.back()));
  }
}

TEST(FindWayTest, KeyTurnsAQuarterInItsHole) {
  ExpectWay(testing::MakeKeyhole(50e-6), 400'000);
}

TEST(FindWayTest, PlateTiltsOutFromBehindALip) {
  ExpectWay(testing::MakeLippedWindow(200e-6), 400'000);
}

TEST(FindWayTest, HookComesOffARail) {
  ExpectWay(testing::MakeRailHook(100e-6), 400'000);
}

TEST(FindWayTest, BentRodLeavesTwoWalls) {
  ExpectWay(testing::MakeCornerRod(200e-6), 400'000);
}

TEST(FindWayTest, ANutComesOffAlongTheScrewThatItsFlanksLeave) {
  const Pair pair = testing::MakeNut(200e-6);
  for (int frame = 0; frame < 2; ++frame) {
    const Pose X_WA = frame == 0 ? Pose() : Askew(frame);
    const Placed placed(pair, X_WA);
    const WaySearch found = Find(placed.problem, 1, 20'000);
    ASSERT_TRUE(found.way.has_value()) << "frame " << frame << ", to go " << found.distance_to_go;
    ASSERT_EQ(found.way->method, WayMethod::kFreeMotion);
    EXPECT_TRUE(IsOut(placed.problem, found.way->path.back()));
    const double step = CheckStepOf(placed.problem.tolerance);
    EXPECT_GE(MeasureDensely(placed.problem, found.way->path, step),
              -placed.problem.tolerance - 0.5 * step);
    const FreeScrew& screw = found.way->screw;
    EXPECT_NEAR(screw.axis.pitch, 2e-3, 0.05e-3) << "right-handed";
    EXPECT_GT(std::abs(screw.axis.axis_W.dot(X_WA.R().col(2))), std::cos(0.02));
    EXPECT_LT((screw.axis.p_WQ - X_WA.p()).cross(screw.axis.axis_W).norm(), 0.1e-3);
    EXPECT_GT(screw.flanks.size(), 100U);
  }
}

TEST(FindWayTest, CaptivePartHasNoWayAndSaysWhatStopsIt) {
  const Placed placed(testing::MakeCaptive(100e-6), Askew(2));
  const WaySearch found = Find(placed.problem, 1, 30'000);
  EXPECT_FALSE(found.way.has_value());
  EXPECT_TRUE(found.is_budget_over);
  EXPECT_FALSE(found.farthest.empty());
  EXPECT_GT(found.distance_to_go, 0);
  ASSERT_FALSE(found.stops.empty());
  EXPECT_EQ(found.stops.front().body, contact::BodyId(0));
}

TEST(FindWayTest, EqualInputGivesTheEqualWay) {
  const Placed placed(testing::MakeLippedWindow(200e-6), Askew(1));
  const WaySearch first = Find(placed.problem, 7, 400'000);
  const WaySearch second = Find(placed.problem, 7, 400'000);
  ASSERT_TRUE(first.way && second.way);
  EXPECT_EQ(first.queries, second.queries);
  ASSERT_EQ(first.way->path.size(), second.way->path.size());
  for (std::size_t i = 0; i < first.way->path.size(); ++i) {
    EXPECT_EQ(first.way->path[i].p(), second.way->path[i].p());
    EXPECT_EQ(first.way->path[i].q().coeffs(), second.way->path[i].q().coeffs());
  }
}

TEST(FindWayTest, StartInsideAnotherBodyIsAnError) {
  Placed placed(testing::MakeCaptive(100e-6), Pose());
  placed.problem.X_WB_start = Pose(Vec3(2e-3, 2e-3, 0));
  const auto found = FindWay(placed.problem, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::kInvalid);
}

}  // namespace
}  // namespace hvas::paths
