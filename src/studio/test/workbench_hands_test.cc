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
  ASSERT_TRUE(AwaitDevice(1, DeviceList::kPointer, start));
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
  ASSERT_TRUE(AwaitDevice(1, DeviceList::kPointer, start));
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
  const std::size_t touch = FindDevice("emulated:openhaptics:touch_x");
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().UseDevice(0, touch, 0));
  ASSERT_TRUE(AwaitDevice(0, touch, start));
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
  ASSERT_TRUE(bench_.hands().UseDevice(0, DeviceList::kPointer, 0));
  EXPECT_TRUE(AwaitDevice(0, DeviceList::kPointer, start));
}

TEST_F(WorkbenchHandsTest, DeviceThatCannotBeUsedIsToldOfAndLeavesTheHandAsItWas) {
  const auto fails = [this](std::size_t hand, std::size_t device) {
    const std::size_t start = log_.size();
    EXPECT_TRUE(bench_.hands().UseDevice(hand, device, 0));
    const auto failed = log_.Await("failed", start);
    return failed && (*failed)["file"] == bench_.hands().devices().entries()[device].name &&
           !(*failed)["error"]["remedy"].empty();
  };
  const std::size_t emulated = FindDevice("emulated:haply");
  EXPECT_TRUE(fails(0, FindDevice("haply")));  // a real one, with a clock that goes by steps
  EXPECT_TRUE(fails(1, emulated));             // there is one hand
  EXPECT_EQ(bench_.hands().Describe()[0]["device"]["index"], DeviceList::kPointer);
  ASSERT_TRUE(bench_.hands().SetCount(2));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.hands().UseDevice(0, emulated, 0));
  ASSERT_TRUE(AwaitDevice(0, emulated, start));
  EXPECT_TRUE(fails(1, emulated));  // it is in the other one
}

TEST_F(WorkbenchHandsTest, DeviceThatTheListDoesNotHaveIsRefused) {
  for (const std::size_t device :
       {bench_.hands().devices().entries().size(), std::size_t{1} << 32}) {
    const auto refused = bench_.hands().UseDevice(0, device, 0);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
  }
}

TEST(DeviceListTest, AddressesOfTheHostAreNotShown) {
  const DeviceList list({"plugin:/opt/secret/device.so", "network:0.0.0.0:4000"});
  EXPECT_EQ(list.entries()[1].address, "plugin:/opt/secret/device.so");
  EXPECT_EQ(list.entries()[2].address, "network:0.0.0.0:4000");
  EXPECT_EQ(list.entries()[1].name, "Device 1 of the command line");
  EXPECT_EQ(list.entries()[2].name, "Device 2 of the command line");
  EXPECT_EQ(list.entries()[1].driver, "plugin");
}

TEST_F(WorkbenchHandsTest, DevicesAreFoundWithoutOpeningThem) {
  bench_.hands().SearchDevices();
  const auto told = log_.Await("devices");
  ASSERT_TRUE(told);
  EXPECT_EQ((*told)["is_searching"], false);
  std::size_t emulated = 0;
  for (const Json& device : (*told)["devices"]) {
    emulated += device["is_emulated"] == true ? 1 : 0;
    EXPECT_FALSE(device.contains("address")) << "a page names a device by its index";
    EXPECT_GT(device["index"].get<std::size_t>(), DeviceList::kPointer);
    EXPECT_FALSE(device["name"].get<std::string>().empty());
  }
  EXPECT_EQ(emulated, device::KnownProfiles().size());
  EXPECT_EQ((*told)["devices"].size(), emulated + device::Drivers().size());
}

}  // namespace
}  // namespace hvas::studio
