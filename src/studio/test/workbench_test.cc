#include "studio/workbench.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "studio/test/workbench_fixture.h"

namespace hvas::studio {
namespace {

using simulation::Placement;
using spatial::Pose;
using testing::EventLog;
using testing::kPeg;

class SceneOpenerTest : public testing::WorkbenchFixture {};

TEST_F(SceneOpenerTest, OpeningTellsOfItsProgressThenOfTheScene) {
  OpenPeg();
  EXPECT_TRUE(log_.Await("progress"));
  EXPECT_EQ((*log_.Await("scene"))["epoch"], 1);
  const auto scene = bench_.live().scene();
  EXPECT_EQ(scene->model->bodies.size(), 2u);
  EXPECT_EQ(scene->glb->substr(0, 4), "glTF");
  EXPECT_EQ(bench_.live().state().parts.size(), 2u);
  EXPECT_TRUE(log_.AwaitTrue([this] { return bench_.live().frame().epoch == 1; }));
}

TEST_F(SceneOpenerTest, WhatCannotBeOpenedLeavesWhatIsOpen) {
  OpenPeg();
  const auto before = bench_.live().scene();
  bench_.opener().Open("missing", "missing");
  const auto failed = log_.Await("failed");
  ASSERT_TRUE(failed);
  EXPECT_EQ((*failed)["error"]["code"], "not-found");
  EXPECT_EQ((*failed)["error"]["remedy"], "name another");
  EXPECT_EQ(bench_.live().scene(), before);
}

/** A workbench that shows first parts however soon the others are ready. */
class FirstPartsTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kCollar = 2;

  FirstPartsTest()
      : bench_([this] {
          WorkbenchOptions options = testing::SmallBench(log_.clock());
          options.scenes.shape_cache = nullptr;
          options.scenes.least_gain = {};
          return options;
        }()) {
    bench_.on_event = [this](Json event) {
      const bool is_first = event["event"] == "scene" && event["why"].is_null();
      const auto on_first =
          is_first ? on_first_ : nullptr;  // A test sets it after it heard of an event.
      log_.Add(std::move(event));
      if (on_first) {
        on_first();
      }
    };
  }

  void TearDown() override { bench_.Stop(); }

  static bool IsWhole(const Json& event) {
    return event["event"] == "scene" && event["why"] == "all parts are ready";
  }

  EventLog log_;
  Workbench bench_;
  std::function<void()> on_first_;  ///< Called while the other parts are prepared.
};

TEST_F(FirstPartsTest, OnlyWhatIsReadyCanBeTakenUntilAllIs) {
  std::vector<Result<TakenParts>> taken;
  std::vector<Result<void>> idle;
  on_first_ = [&] {
    idle.push_back(bench_.live().CheckIdle());
    taken.push_back(bench_.hands().Take(0, product::OccurrenceId(kCollar)));
  };
  bench_.opener().Open("collar.step", "collar");
  ASSERT_TRUE(log_.Await(IsWhole));
  ASSERT_EQ(taken.size(), 1u);
  ASSERT_FALSE(taken[0]);
  EXPECT_EQ(taken[0].error().message, "the part is still being prepared");
  ASSERT_FALSE(idle[0]);
  EXPECT_EQ(idle[0].error().message, "the product is still being prepared");
  EXPECT_EQ(bench_.live().state().parts[kCollar].placement, Placement::kLoose);
  EXPECT_TRUE(bench_.live().CheckIdle());
  EXPECT_TRUE(bench_.hands().Take(0, product::OccurrenceId(kCollar)));
}

TEST_F(FirstPartsTest, APartInTheHandIsNotTakenAway) {
  on_first_ = [&] { ASSERT_TRUE(bench_.hands().Take(0, product::OccurrenceId(kPeg))); };
  bench_.opener().Open("collar.step", "collar");
  ASSERT_TRUE(log_.Await("taken"));
  const auto is_ready = [](const Json& event) {
    return event["event"] == "progress" && event["stage"] == "ready";
  };
  ASSERT_TRUE(log_.Await(is_ready));
  log_.Pass(0.3);
  EXPECT_FALSE(log_.Find(IsWhole));
  EXPECT_TRUE(bench_.live().is_holding());
  ASSERT_TRUE(bench_.hands().Release(0));
  ASSERT_TRUE(log_.Await(IsWhole));
  EXPECT_EQ(bench_.live().state().parts[kPeg].placement, Placement::kLoose);
}

TEST_F(FirstPartsTest, WhatWasOpenComesBackWhereThePreparationIsCancelled) {
  bench_.opener().Open("peg.step", "peg");
  ASSERT_TRUE(log_.Await("scene"));
  const auto before = bench_.live().scene();
  on_first_ = [&] { bench_.opener().Cancel(); };
  bench_.opener().Open("collar.step", "collar");
  const auto failed = log_.Await("failed");
  ASSERT_TRUE(failed);
  EXPECT_EQ((*failed)["error"]["code"], "cancelled");
  EXPECT_EQ(bench_.live().scene(), before);
}

TEST_F(FirstPartsTest, AStudyShowsTheWholeProduct) {
  bench_.opener().Open("collar.step", "collar", SceneOpener::When::kWhole);
  ASSERT_TRUE(log_.Await("scene"));
  EXPECT_EQ(simulation::CountPending(*bench_.live().scene()->model), 0u);
}

class LiveSceneTest : public testing::WorkbenchFixture {};

TEST_F(LiveSceneTest, ForcesAreOffUntilTheyAreSwitchedOn) {  // N6
  OpenPeg();
  TakePeg();
  // Down into the table: a force, if there may be one.
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, -0.01))), 0.3);
  const auto force = [this] {
    bench_.hands().Move(hand_, X_WH_, true);
    const auto frame = bench_.live().frame().frame;
    return frame.ticks.empty() ? 0.0 : frame.ticks[0].F_H_W.f.norm();
  };
  EXPECT_TRUE(log_.AwaitTrue([&] { return force() > 0.1; }));
  bench_.live().SetForcesOff(true);
  EXPECT_TRUE(bench_.live().forces_off());
  EXPECT_TRUE(log_.AwaitTrue([&] { return force() == 0; }));
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(force(), 0);
    log_.Pass(0.01);
  }
  bench_.live().SetForcesOff(false);
  EXPECT_TRUE(log_.AwaitTrue([&] { return force() > 0.1; }));
}

TEST_F(LiveSceneTest, ForcesStayOffInTheNextRun) {  // N6
  bench_.live().SetForcesOff(true);
  OpenPeg();
  EXPECT_TRUE(bench_.live().forces_off());
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, -0.01))), 0.3);
  for (int i = 0; i < 30; ++i) {
    bench_.hands().Move(hand_, X_WH_, true);
    const auto frame = bench_.live().frame().frame;
    ASSERT_EQ(frame.ticks.size(), 1u);
    EXPECT_EQ(frame.ticks[0].F_H_W.f.norm(), 0);
    log_.Pass(0.01);
  }
}

class WorkbenchDemoTest : public testing::WorkbenchFixture {};

TEST_F(WorkbenchDemoTest, SimulatedPersonDoesTheNextStep) {
  OpenPeg();
  ASSERT_TRUE(log_.AwaitTrue([this] { return bench_.live().state().next_step == 1; }));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.demo().DoNext());
  ASSERT_TRUE(AwaitPlacementEvent("placed", start));
  const auto ended = log_.Await(
      [](const Json& event) { return event["event"] == "demo" && event["on"] == false; }, start);
  EXPECT_TRUE(ended);
  EXPECT_FALSE(bench_.live().is_demo());
  EXPECT_EQ(PlacementOf(kPeg), Placement::kPlaced);
}

TEST_F(WorkbenchDemoTest, X16SimulatedPersonGetsAPartOutAgain) {
  OpenPeg();
  ASSERT_TRUE(log_.AwaitTrue([this] { return bench_.live().state().next_step == 1; }));
  std::size_t start = log_.size();
  const auto await_end = [&] {
    return log_.Await(
        [](const Json& event) { return event["event"] == "demo" && event["on"] == false; }, start);
  };
  using simulation::DisassemblyPlan;
  std::promise<Result<DisassemblyPlan>> too_early;
  ASSERT_TRUE(bench_.demo().PlanRemoval(
      product::OccurrenceId(kPeg),
      [&](const Result<DisassemblyPlan>& plan) { too_early.set_value(plan); }));
  EXPECT_EQ(too_early.get_future().get().error().message, "the part is not in its place");
  ASSERT_TRUE(bench_.demo().DoNext());
  ASSERT_TRUE(await_end());
  ASSERT_EQ(PlacementOf(kPeg), Placement::kPlaced);
  start = log_.size();
  std::promise<Result<DisassemblyPlan>> planned;
  ASSERT_TRUE(
      bench_.demo().TakeOut(product::OccurrenceId(kPeg),
                            [&](const Result<DisassemblyPlan>& plan) { planned.set_value(plan); }));
  const auto plan = planned.get_future().get();
  ASSERT_TRUE(plan) << plan.error().ToString();
  EXPECT_EQ(plan->removals.size(), 1U);
  ASSERT_TRUE(await_end());
  EXPECT_EQ(PlacementOf(kPeg), Placement::kLoose);
  EXPECT_EQ(bench_.live().state().next_step, 1U);  // the peg's step is to be done again
  std::promise<Result<DisassemblyPlan>> base;
  ASSERT_TRUE(
      bench_.demo().TakeOut(product::OccurrenceId(0),
                            [&](const Result<DisassemblyPlan>& made) { base.set_value(made); }));
  EXPECT_EQ(base.get_future().get().error().message,
            "the part is the base, which stays in the fixture");
}

class WorkbenchTest : public testing::WorkbenchFixture {};

TEST_F(WorkbenchTest, StopsWhileAFileIsBeingOpened) {
  bench_.opener().Open("peg.step", "peg");
  bench_.opener().Open("peg.step", "peg");
  bench_.Stop();
  const std::size_t told = log_.size();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(log_.size(), told);
}

TEST(WorkbenchStopTest, WhatHasNotBegunIsDropped) {
  EventLog log;
  WorkbenchOptions options = testing::SmallBench(log.clock());
  options.scenes.load = [load = options.scenes.load](
                            const std::filesystem::path& file, const cad::ProgressFn& progress,
                            const std::stop_token& stop, Diagnostics* diagnostics) {
    while (file == "slow.step" && !stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return load(file, progress, stop, diagnostics);
  };
  Workbench bench(options);
  bench.on_event = [&log](Json event) { log.Add(std::move(event)); };
  bench.opener().Open("peg.step", "peg");
  ASSERT_TRUE(log.Await("scene"));
  bench.opener().Open("slow.step", "slow");
  int changes = 0;
  const auto change = [&changes](product::Product*) -> Result<void> {
    ++changes;
    return {};
  };
  ASSERT_TRUE(bench.edits().Change({"behind it", nullptr, change}));  // is tried at once
  bench.Stop();
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace hvas::studio
