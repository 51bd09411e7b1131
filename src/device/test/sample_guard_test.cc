#include "device/sample_guard.h"

#include <limits>

#include <gtest/gtest.h>

#include "device/test/tick_time.h"

namespace hvas::device {
namespace {

using testing::kTickNs;

DeviceState At(std::int64_t tick, double x) {
  DeviceState state;
  state.t_ns = tick * kTickNs;
  state.X_DH = spatial::Pose(Vec3(x, 0, 0));
  return state;
}

SampleGuard MakeGuard() {
  return {50e-6, 1e-3};
}

TEST(SampleGuardTest, AHandMovesFreely) {  // N8
  SampleGuard guard = MakeGuard();
  for (int i = 0; i < 100; ++i) {
    const DeviceState state = guard.Accept(At(i, 3e-3 * i));  // 3 m/s
    EXPECT_TRUE(state.is_valid) << i;
    EXPECT_EQ(state.condition, Condition::kReady);
  }
}

TEST(SampleGuardTest, AJumpIsNotBelievedUntilItIsSteady) {
  SampleGuard guard = MakeGuard();
  EXPECT_TRUE(guard.Accept(At(0, 0)).is_valid);
  int first_valid = 0;
  for (int i = 1; i < 100 && first_valid == 0; ++i) {
    const DeviceState state = guard.Accept(At(i, 0.08));
    EXPECT_EQ(state.condition == Condition::kReady, state.is_valid);
    first_valid = state.is_valid ? i : 0;
  }
  EXPECT_EQ(first_valid, 1 + SampleGuard::kSettleNs / kTickNs);
  DeviceState turned = At(99, 0.08);
  turned.X_DH = {Quat(0, 1, 0, 0), turned.X_DH.p()};
  EXPECT_EQ(guard.Accept(turned).condition, Condition::kImplausible);
}

TEST(SampleGuardTest, NotANumberNeverPasses) {
  SampleGuard guard = MakeGuard();
  EXPECT_TRUE(guard.Accept(At(0, 0.01)).is_valid);
  for (int field = 0; field < 4; ++field) {
    DeviceState bad = At(1 + field, 0.01);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    switch (field) {
      case 0:
        bad.X_DH = spatial::Pose(Vec3(0, kNan, 0));
        break;
      case 1:
        bad.X_DH = {Quat(kNan, 0, 0, 0), Vec3::Zero()};
        break;
      case 2:
        bad.V_DH.v.z() = kInfinity;
        break;
      default:
        bad.V_DH.w.x() = kNan;
    }
    const DeviceState state = guard.Accept(bad);
    EXPECT_FALSE(state.is_valid);
    EXPECT_EQ(state.condition, Condition::kImplausible);
    EXPECT_TRUE(spatial::IsFinite(state.X_DH));
    EXPECT_TRUE(state.V_DH.v.allFinite() && state.V_DH.w.allFinite());
  }
  EXPECT_FALSE(guard.Accept(At(5, 0.01)).is_valid);
  EXPECT_TRUE(guard.Accept(At(60, 0.01)).is_valid);
}

TEST(SampleGuardTest, WithoutANewSampleItIsStaleWithinFiveMilliseconds) {
  SampleGuard guard = MakeGuard();
  EXPECT_FALSE(guard.Repeat(0).is_valid);  // never had one
  DeviceState moving = At(0, 0);
  moving.V_DH.v.x() = 0.1;
  (void)guard.Accept(moving);
  double speed = 0.1;
  for (int i = 1; i <= 3; ++i) {
    const DeviceState state = guard.Repeat(i * kTickNs);
    EXPECT_TRUE(state.is_valid) << i;
    EXPECT_LT(state.V_DH.v.norm(), speed);
    speed = state.V_DH.v.norm();
  }
  EXPECT_EQ(guard.Repeat(4 * kTickNs).condition, Condition::kStale);
  EXPECT_FALSE(guard.Repeat(4 * kTickNs).is_valid);
  EXPECT_TRUE(guard.Accept(At(6, 0.001)).is_valid);
}

TEST(SampleGuardTest, AnOldWrenchFades) {  // N6: no force outlives who computed it
  EXPECT_EQ(ShareOfAge(0), 1);
  EXPECT_EQ(ShareOfAge(20 * kTickNs), 1);
  EXPECT_NEAR(ShareOfAge(45 * kTickNs), 0.5, 1e-12);
  EXPECT_EQ(ShareOfAge(70 * kTickNs), 0);
  EXPECT_EQ(ShareOfAge(1'000'000 * kTickNs), 0);
}

// A driver's own thread that stood still: N6. What the haptic thread gave before is not shown
// again, though it may be young enough for a thread that was there all the time.
TEST(SampleGuardTest, WrenchOfBeforeAPauseOfTheThreadIsNotShownAfterIt) {
  for (const std::int64_t pause : {21, 30, 60, 5000}) {
    ForceHold hold;
    std::int64_t t = 1000;
    for (; t < 1100; ++t) {
      EXPECT_EQ(hold.CalcShare(t * kTickNs, t * kTickNs), 1);
    }
    const std::int64_t given = t - 1;
    t += pause;
    for (int k = 0; k < 100; ++k) {
      EXPECT_EQ(hold.CalcShare(given * kTickNs, (t + k) * kTickNs), 0) << pause;
    }
    EXPECT_EQ(hold.CalcShare((t + 100) * kTickNs, (t + 100) * kTickNs), 1);
  }
  ForceHold back;
  EXPECT_EQ(back.CalcShare(1000 * kTickNs, 1000 * kTickNs), 1);
  EXPECT_EQ(back.CalcShare(500 * kTickNs, 900 * kTickNs), 0) << "the clock went back";
  // Without a pause it ages as before.
  ForceHold steady;
  for (std::int64_t age = 0; age < 100; ++age) {
    EXPECT_EQ(steady.CalcShare(kTickNs, (1 + age) * kTickNs), ShareOfAge(age * kTickNs));
  }
}

}  // namespace
}  // namespace hvas::device
