// What is kept of a trial's ticks: the wrenches of its last seconds (X15), its time and its
// contacts.

#include "study/trial_watch.h"

#include <gtest/gtest.h>

namespace hvas::study {
namespace {

using product::OccurrenceId;

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kWindow = 3;     // [s]
const OccurrenceId kShaft(2);

/** Feeds a tick whose force is 1 N along x of W and its index in newtons along z. */
void Tick(int index, haptics::HoldState state, int contacts, TrialWatch* watch) {
  device::DeviceState device;
  device.t_ns = 1'000'000LL * index;
  haptics::TickOutput out;
  out.occurrence = kShaft;
  out.state = state;
  out.contact_count = contacts;
  out.F_H_W.f = Vec3(1, 0, index);
  out.F_H_W.t = Vec3(0, 0.001 * index, 0);
  watch->OnTick(0, device, out);
}

TEST(TrialWatchTest, X15WrenchesOfTheLastSecondsAreKeptInTheFrameOfExtraction) {
  constexpr int kSeatedAt = 5000;
  const Vec3 up_W = Vec3::UnitX();  // of extraction: the frame's z axis
  TrialWatch watch(kShaft, up_W, kWindow, kPeriod, nullptr);
  for (int i = 0; i < kSeatedAt; ++i) {
    Tick(i, haptics::HoldState::kMating, 0, &watch);
  }
  Tick(kSeatedAt, haptics::HoldState::kSeated, 0, &watch);
  Tick(kSeatedAt + 1, haptics::HoldState::kSeated, 0, &watch);  // is after the trial
  const TrialResult result = watch.MakeResult();
  EXPECT_EQ(result.outcome, Outcome::kDone);
  EXPECT_NEAR(*result.time, 5, 1e-9);
  ASSERT_GT(result.mating.size(), 100U);
  EXPECT_DOUBLE_EQ(result.mating.back().t, 0);
  EXPECT_NEAR(result.mating.front().t, -kWindow, 0.01 * kWindow);
  for (const MatingSample& sample : result.mating) {
    const double index = kSeatedAt + sample.t / kPeriod;
    EXPECT_NEAR(sample.f.z(), 1, 1e-12);  // along the extraction
    EXPECT_NEAR(sample.f.head<2>().norm(), index, 1e-6);
    EXPECT_NEAR(sample.torque.norm(), 0.001 * index, 1e-9);
  }
}

TEST(TrialWatchTest, ContactsThatBeginBeforeAMateGuidesThePartAreCounted) {
  TrialWatch watch(kShaft, Vec3::UnitZ(), kWindow, kPeriod, nullptr);
  int index = 0;
  const auto feed = [&](int ticks, haptics::HoldState state, int contacts) {
    for (int i = 0; i < ticks; ++i) {
      Tick(index++, state, contacts, &watch);
    }
  };
  feed(50, haptics::HoldState::kFree, 0);
  feed(50, haptics::HoldState::kFree, 1);
  feed(50, haptics::HoldState::kFree, 0);  // too short a pause: the same contact
  feed(50, haptics::HoldState::kFree, 2);
  feed(200, haptics::HoldState::kFree, 0);
  feed(50, haptics::HoldState::kFree, 1);
  feed(200, haptics::HoldState::kCaptured, 0);
  feed(50, haptics::HoldState::kCaptured, 1);  // guided already
  EXPECT_EQ(watch.MakeResult().collisions, 2);
  EXPECT_EQ(watch.MakeResult().outcome, Outcome::kNotDone);
}

}  // namespace
}  // namespace hvas::study
