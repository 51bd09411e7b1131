#include "studio/workbench_hands.h"

#include <chrono>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "device/driver.h"
#include "studio/test/workbench_fixture.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using simulation::Placement;
using spatial::Pose;
using testing::kBlock;
using testing::kPeg;

class WorkbenchHandsTest : public testing::WorkbenchFixture {};

TEST_F(WorkbenchHandsTest, PartIsTakenMovedAlongItsAxisAndSeated) {
  OpenPeg();
  TakePeg();
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kHeld));
  EXPECT_FALSE(bench_.hands().Take(hand_, OccurrenceId(kPeg)));  // one part in a hand
  EXPECT_FALSE(bench_.edits().Undo());
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  const std::size_t start = log_.size();
  ReleasePeg();
  const auto dropped = log_.Await("dropped", start);
  ASSERT_TRUE(dropped);
  EXPECT_EQ((*dropped)["was_seated"], true);
  EXPECT_EQ((*dropped)["to_place_mm"], 0);
  EXPECT_EQ((*dropped)["occurrence"], kPeg);
  EXPECT_GT((*dropped)["metrics"]["time_s"], 1);
  EXPECT_GT((*dropped)["metrics"]["path_mm"], 50);
  EXPECT_TRUE(AwaitPlacementEvent("placed", start));
  const Pose X_WB = bench_.live().state().parts[kPeg].X_WB;
  EXPECT_LT((X_WB.p() - bench_.live().scene()->model->bodies[kPeg].X_WB_goal.p()).norm(), 1e-6);
}

TEST_F(WorkbenchHandsTest, X16SeatedPartIsTakenOutAgain) {
  OpenPeg();
  EXPECT_FALSE(bench_.hands().Take(hand_, OccurrenceId(kBlock)));  // stands in its fixture
  TakePeg();
  InsertPeg();
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), X_WB_start_.p() + Vec3(0.05, 0, 0.08)), 2);
  ReleasePeg();
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  EXPECT_TRUE(
      log_.AwaitTrue([this] { return bench_.live().state().next_step == 1; }));  // to be done again
  ASSERT_TRUE(bench_.edits().Undo());
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
}

TEST_F(WorkbenchHandsTest, HeldPartStaysAndTheForceGoesWhenNothingIsHeard) {  // N11: 250 ms
  OpenPeg();
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, 0.05))), 0.6);
  // Nobody sends anything any more: the operator is gone.
  auto before = bench_.live().frame().frame;
  EXPECT_TRUE(log_.AwaitTrue([&] {
    before = bench_.live().frame().frame;
    return before.ticks.size() == 1 && before.ticks[0].F_H_W.f.norm() == 0 &&
           before.ticks[0].F_H_W.t.norm() == 0;
  }));
  auto after = before;
  EXPECT_TRUE(log_.AwaitTrue([&] {
    after = bench_.live().frame().frame;
    return after.t_ns > before.t_ns + 300'000'000;
  }));
  EXPECT_LT((after.X_WB[kPeg].p() - before.X_WB[kPeg].p()).norm(), 1e-4);
  EXPECT_EQ(PlacementOf(kPeg), Placement::kHeld);  // neither dropped nor moved on
}

TEST_F(WorkbenchHandsTest, SecondHandDoesWhatTheFirstOneDoes) {  // N11: two hands
  OpenPeg();
  EXPECT_FALSE(bench_.hands().Take(1, OccurrenceId(kPeg)));  // there is one hand only
  EXPECT_FALSE(bench_.hands().SetCount(0));
  EXPECT_FALSE(bench_.hands().SetCount(HandRack::kMaxHands + 1));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().SetCount(2));
  ASSERT_TRUE(AwaitDevice(1, HandRack::kPointer, start));
  hand_ = 1;
  TakePeg();
  EXPECT_FALSE(bench_.hands().Take(0, OccurrenceId(kPeg)));  // it is in the other hand
  EXPECT_FALSE(bench_.hands().SetCount(1));
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(bench_.live().frame().frame.ticks.size(), 2u);
  EXPECT_FALSE(bench_.live().frame().frame.ticks[0].occurrence.is_valid());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  ASSERT_TRUE(bench_.edits().Undo());
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  ASSERT_TRUE(bench_.hands().SetCount(1));
  EXPECT_TRUE(log_.AwaitTrue([this] { return bench_.live().frame().frame.ticks.size() == 1; }));
}

TEST_F(WorkbenchHandsTest, PartGoesFromOneHandIntoTheOtherBeforeItFalls) {
  OpenPeg();
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().SetCount(2));
  ASSERT_TRUE(AwaitDevice(1, HandRack::kPointer, start));
  EXPECT_FALSE(bench_.hands().HandOver(0, 1));  // nothing is in it
  TakePeg();
  EXPECT_FALSE(bench_.hands().HandOver(0, 0));
  EXPECT_FALSE(bench_.hands().HandOver(1, 0));
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, 0.08))), 0.8);
  const double height = bench_.live().frame().frame.X_WB[kPeg].p().z();
  ASSERT_TRUE(bench_.hands().HandOver(0, 1));
  ASSERT_TRUE(log_.AwaitTrue([this] {
    const auto ticks = bench_.live().frame().frame.ticks;
    return ticks.size() == 2 && ticks[1].occurrence.is_valid() && !ticks[0].occurrence.is_valid();
  }));
  EXPECT_EQ(PlacementOf(kPeg), Placement::kHeld);
  EXPECT_NEAR(bench_.live().frame().frame.X_WB[kPeg].p().z(), height, 5e-3);
  hand_ = 1;
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
}

TEST_F(WorkbenchHandsTest, EmulatedDeviceInsertsThePegByThePointer) {  // N3
  OpenPeg();
  constexpr const char* kAddress = "emulated:openhaptics:touch_x";
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().UseDevice(0, kAddress, 0));
  ASSERT_TRUE(AwaitDevice(0, kAddress, start));
  EXPECT_TRUE(
      log_.AwaitTrue([this] { return bench_.hands().Describe()[0]["condition"] == "ready"; }));
  const Json hand = bench_.hands().Describe()[0];
  EXPECT_EQ(hand["device"]["is_emulated"], true);
  EXPECT_GT(hand["device"]["max_force_n"], 1);
  EXPECT_GT(hand["device"]["scale"], 0);
  EXPECT_FALSE(hand["device"]["notes"].empty());
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  ASSERT_TRUE(bench_.hands().UseDevice(0, HandRack::kPointer, 0));
  EXPECT_TRUE(AwaitDevice(0, HandRack::kPointer, start));
}

TEST_F(WorkbenchHandsTest, DeviceThatCannotBeUsedIsToldOfAndLeavesTheHandAsItWas) {
  const auto fails = [this](std::size_t hand, const std::string& address) {
    const std::size_t start = log_.size();
    EXPECT_TRUE(bench_.hands().UseDevice(hand, address, 0));
    const auto failed = log_.Await("failed", start);
    return failed && (*failed)["file"] == address && !(*failed)["error"]["remedy"].empty();
  };
  EXPECT_TRUE(fails(0, "nonsense"));
  EXPECT_TRUE(fails(0, "emulated:openhaptics:nonsense"));
  EXPECT_TRUE(fails(1, "emulated:openhaptics"));  // there is one hand
  EXPECT_EQ(bench_.hands().Describe()[0]["device"]["address"], HandRack::kPointer);
  ASSERT_TRUE(bench_.hands().SetCount(2));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().UseDevice(0, "emulated:haply", 0));
  ASSERT_TRUE(AwaitDevice(0, "emulated:haply", start));
  EXPECT_TRUE(fails(1, "emulated:haply"));  // it is in the other one
}

TEST_F(WorkbenchHandsTest, DevicesAreFoundWithoutOpeningThem) {
  bench_.hands().SearchDevices();
  const auto told = log_.Await("devices");
  ASSERT_TRUE(told);
  EXPECT_EQ((*told)["is_searching"], false);
  std::size_t emulated = 0;
  for (const Json& device : (*told)["devices"]) {
    emulated += device["is_emulated"] == true ? 1 : 0;
    EXPECT_FALSE(device["address"].get<std::string>().empty());
    EXPECT_FALSE(device["name"].get<std::string>().empty());
  }
  EXPECT_EQ(emulated, device::KnownProfiles().size());
  EXPECT_EQ((*told)["devices"].size(), emulated + device::Drivers().size());
}

}  // namespace
}  // namespace hvas::studio
