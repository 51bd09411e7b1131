// Every force device behind a wire: a wall, each fault, 500 random schedules of faults (X4, N6,
// N8).
#include <cmath>

#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using testing::kTickNs;
using testing::OptionsOf;
using testing::Push;
using testing::WireRig;

constexpr int kSettleTicks = 600;  // to be ready again after any fault

struct Case {
  const Driver& (*driver)();
  const char* profile;
  const char* name;
};

class ForceDeviceTest : public ::testing::TestWithParam<Case> {};

EmulatorOptions Frictionless(const std::string& profile) {
  EmulatorOptions options = OptionsOf(profile);
  options.profile.friction = 0.01;
  return options;
}

TEST_P(ForceDeviceTest, AWallHoldsTheHandAtItsNominalStiffness) {  // F = -k x
  WireRig rig(GetParam().driver(), Frictionless(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  EXPECT_TRUE(rig.device().info().is_emulated);
  const double stiffness = rig.device().info().profile.max_stiffness;
  ASSERT_EQ(stiffness, FindProfile(GetParam().profile)->profile.max_stiffness);
  constexpr double kPress = 2.5;    // [N]
  constexpr double kDamping = 1.0;  // [N s/m]
  HandIntent hand;
  hand.stiffness = 0;
  hand.force = Vec3(-kPress, 0, 0);
  rig.hardware().SetHand(hand);
  for (int i = 0; i < 1500; ++i) {
    const DeviceState state = rig.Read();
    const double x = state.X_DH.p().x();
    rig.device().Write(Push(x < 0 ? -stiffness * x - kDamping * state.V_DH.v.x() : 0));
  }
  const auto truth = rig.truth();
  EXPECT_NEAR(truth.F_H_D.f.x(), kPress, 0.02 * kPress);
  EXPECT_NEAR(-stiffness * truth.X_DH.p().x(), kPress, 0.02 * kPress);
  EXPECT_LT(std::hypot(truth.F_H_D.f.y(), truth.F_H_D.f.z()), 1e-9);
  EXPECT_LT(truth.V_DH.v.norm(), 1e-3);
}

TEST_P(ForceDeviceTest, EachAxisOfAForceArrivesAsItself) {
  WireRig rig(GetParam().driver(), OptionsOf(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  HandIntent hand;
  hand.stiffness = 3000;
  rig.hardware().SetHand(hand);
  rig.RunUntilReady(kSettleTicks);
  for (int axis = 0; axis < 3; ++axis) {
    spatial::Wrench F;
    F.f[axis] = 1.5 - axis;
    rig.Run(20, F);
    EXPECT_LT((rig.truth().F_H_D.f - F.f).norm(), 1e-6) << axis;
  }
}

TEST_P(ForceDeviceTest, AFaultTakesTheForceAwayWithinFiveMillisecondsAndItComesBack) {
  WireRig rig(GetParam().driver(), OptionsOf(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  rig.hardware().SetHand({});
  const spatial::Wrench F = Push(1);
  for (const Fault fault : kFaults) {
    if (fault == Fault::kSignFlipped) {
      continue;  // the safety gate's business: the device itself says that all is well
    }
    SCOPED_TRACE(ToString(fault));
    ASSERT_LE(rig.RunUntilReady(kSettleTicks, F), kSettleTicks);
    rig.Run(20, F);
    ASSERT_NEAR(rig.truth().F_H_D.f.x(), 1, 1e-9);
    rig.hardware().SetFault(fault);
    const DeviceState state = rig.Run(5, F);
    rig.emulator().Advance(kTickNs);
    EXPECT_EQ(rig.truth().F_H_D.f.norm(), 0);
    EXPECT_NE(state.condition, Condition::kReady);
    EXPECT_FALSE(rig.device().Explain(state).empty());
    EXPECT_TRUE(spatial::IsFinite(state.X_DH));
    rig.Run(30, F);
    EXPECT_EQ(rig.truth().F_H_D.f.norm(), 0);
    rig.hardware().SetFault(Fault::kNone);
  }
  EXPECT_LE(rig.RunUntilReady(kSettleTicks, F), kSettleTicks);
}

TEST_P(ForceDeviceTest, ClosingTakesTheForceAway) {
  WireRig rig(GetParam().driver(), OptionsOf(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  rig.hardware().SetHand({});
  for (int i = 0; i < 3; ++i) {
    ASSERT_LE(rig.RunUntilReady(kSettleTicks, Push(1)), kSettleTicks);
    rig.Run(5, Push(1));
    EXPECT_NEAR(rig.truth().F_H_D.f.x(), 1, 1e-9);
    rig.Close();
    rig.emulator().Advance(3 * kTickNs);
    EXPECT_EQ(rig.truth().F_H_D.f.norm(), 0);
    rig.Open(GetParam().driver());
    ASSERT_TRUE(rig.is_open());
  }
}

TEST_P(ForceDeviceTest, WithoutWritesTheForceEnds) {  // N6: a haptic thread that hangs
  WireRig rig(GetParam().driver(), OptionsOf(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  rig.hardware().SetHand({});
  rig.RunUntilReady(kSettleTicks);
  rig.Run(20, Push(1));
  rig.emulator().Advance(25 * kTickNs);
  EXPECT_EQ(rig.truth().F_H_D.f.norm(), 0);
}

/** Faults that come and go, one after the other. */
void RunSchedule(std::uint64_t seed, WireRig* rig) {
  Random random(seed);
  const double peak = rig->device().info().profile.max_force;
  const int fault_count = 1 + static_cast<int>(random.Uniform(0, 3));
  const auto check = [&](const DeviceState& state) {
    ASSERT_TRUE(spatial::IsFinite(state.X_DH));
    ASSERT_TRUE(state.V_DH.v.allFinite() && state.V_DH.w.allFinite());
    ASSERT_LE(rig->truth().F_H_D.f.norm(), peak + 1e-9);
    ASSERT_TRUE(rig->truth().F_H_D.f.allFinite());
  };
  for (int i = 0; i < fault_count; ++i) {
    const auto which = static_cast<std::size_t>(random.Uniform(0, kFaults.size() - 1.0));
    const Fault fault = kFaults[which];  // sign-flipped is the last one, and left out
    const spatial::Wrench F = Push(random.Uniform(-2 * peak, 2 * peak));
    for (int k = static_cast<int>(random.Uniform(1, 60)); k > 0; --k) {
      check(rig->Run(1, F));
    }
    if (fault == Fault::kJump) {  // it takes a pose to jump from
      ASSERT_LE(rig->RunUntilReady(kSettleTicks, F), kSettleTicks);
    }
    rig->hardware().SetFault(fault);
    double force = rig->truth().F_H_D.f.norm();
    for (int k = 1, end = static_cast<int>(random.Uniform(1, 50)); k <= end; ++k) {
      check(rig->Run(1, F));
      const double now = rig->truth().F_H_D.f.norm();
      ASSERT_TRUE(k <= 5 || now == 0 || now < force) << ToString(fault) << " tick " << k;
      force = now;
    }
    rig->hardware().SetFault(Fault::kNone);
  }
  ASSERT_LE(rig->RunUntilReady(kSettleTicks, Push(1)), kSettleTicks);
}

TEST_P(ForceDeviceTest, FiveHundredRandomSchedulesEndReady) {
  WireRig rig(GetParam().driver(), OptionsOf(GetParam().profile));
  ASSERT_TRUE(rig.is_open());
  rig.hardware().SetHand({});
  for (std::uint64_t seed = 1; seed <= 500 && !HasFatalFailure(); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    RunSchedule(seed, &rig);
  }
}

INSTANTIATE_TEST_SUITE_P(Wire, ForceDeviceTest,
                         ::testing::Values(Case{PluginDriver, "touch_x", "plugin"},
                                           Case{NetworkDriver, "network", "network"},
                                           Case{HaplyDriver, "inverse3", "haply"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace hvas::device
