// What is alike for the drivers that load a vendor's library: forces, faults, recovery (N6, N8,
// X4).

#include <algorithm>
#include <fstream>

#include "base/random.h"
#include "device/drivers/dynamic_library.h"
#include "device/test/library_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

class LibraryFaultsTest : public ::testing::TestWithParam<const LibraryCase*> {
 protected:
  [[nodiscard]] const LibraryCase& which() const { return *GetParam(); }

  [[nodiscard]] DeviceProfile profile() const {
    return WithoutFriction(ProfileNamed(which().profile));
  }
};

INSTANTIATE_TEST_SUITE_P(Drivers, LibraryFaultsTest,
                         ::testing::Values(&kOpenHaptics, &kForceDimension, &kVirtuose),
                         [](const auto& entry) { return entry.param->name; });

TEST_P(LibraryFaultsTest, X4TheHandRestsInAWallOfNominalStiffnessWhereThePhysicsSay) {  // N6
  const double k = profile().max_stiffness;
  Rig rig(which(), profile());
  const Law wall = Wall(k, 2);
  rig.Run(which().start_ms, wall);
  constexpr double kPress = 2.5;
  rig.SetHand(PressingHand(kPress, k));
  rig.Run(1500, wall);
  const auto truth = rig.emulated().truth();
  EXPECT_NEAR(truth.F_H_D.f.x(), kPress, 0.02 * kPress);
  const HandIntent hand = PressingHand(kPress, k);
  const double pull = hand.stiffness * (hand.X_DR.p().x() - truth.X_DH.p().x());
  EXPECT_NEAR(truth.F_H_D.f.x() + pull, 0, 0.02 * kPress);
  EXPECT_LT(truth.V_DH.v.norm(), 0.01);
}

TEST_P(LibraryFaultsTest, ANewtonInIsANewtonOutOnEveryAxisBothWays) {
  Rig rig(which(), profile());
  rig.Run(which().start_ms);
  const bool has_torque = rig.device().info().capabilities.torque_axes == 3;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      spatial::Wrench F;
      F.f[axis] = sign;
      F.t[axis] = 0.1 * sign;
      rig.Run(4, [&](const DeviceState&) { return F; });
      const auto truth = rig.emulated().truth();
      EXPECT_LT((truth.F_H_D.f - F.f).norm(), 1e-6);
      EXPECT_LT((truth.F_H_D.t - (has_torque ? F.t : Vec3::Zero())).norm(), 1e-6);
    }
  }
}

TEST_P(LibraryFaultsTest, NoForceIsBeyondTheProfileNorNotANumber) {
  Rig rig(which(), profile());
  rig.Run(which().start_ms);
  spatial::Wrench F;
  F.f = Vec3(300, 0, 400);
  rig.Run(3, [&](const DeviceState&) { return F; });
  const Vec3 limited = rig.emulated().truth().command.f;
  EXPECT_NEAR(limited.norm(), rig.device().info().profile.max_force, 1e-5);
  EXPECT_NEAR(limited.x() / limited.z(), 0.75, 1e-6);
  F.f.x() = std::nan("");
  rig.Run(3, [&](const DeviceState&) { return F; });
  EXPECT_EQ(rig.emulated().truth().command.f.norm(), 0);
}

TEST_P(LibraryFaultsTest, EachFaultTakesTheForceAwayWithin5MillisecondsAndEnds) {  // N6
  const double k = profile().max_stiffness;
  const Law wall = Wall(k, 2);
  for (const Fault fault : kFaults) {
    if (fault == Fault::kSignFlipped) {
      continue;  // No driver can see it: the safety gate's business.
    }
    SCOPED_TRACE(ToString(fault));
    Rig rig(which(), profile());
    rig.SetHand(PressingHand(2.5, k));
    rig.Run(which().start_ms + 500, wall);
    ASSERT_GT(rig.emulated().truth().F_H_D.f.x(), 2);
    rig.emulated().SetFault(fault);
    double last = rig.emulated().truth().F_H_D.f.norm();
    int not_ready = 0;
    for (int ms = 1; ms <= 40; ++ms) {
      const DeviceState state = rig.Tick(wall);
      not_ready += state.condition != Condition::kReady ? 1 : 0;
      const double force = rig.emulated().truth().F_H_D.f.norm();
      EXPECT_TRUE(spatial::IsFinite(state.X_DH));
      if (ms >= 5) {
        EXPECT_LE(force, last + 1e-9) << ms << " ms";
      }
      last = force;
    }
    EXPECT_EQ(last, 0);
    EXPECT_GE(not_ready, fault == Fault::kForceRefused ? 20 : 30);
    rig.emulated().SetFault(Fault::kNone);
    const DeviceState after = rig.Run(which().start_ms + 700, wall);
    EXPECT_EQ(after.condition, Condition::kReady);
    EXPECT_TRUE(after.is_valid);
    EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 2.5, 0.1);
  }
}

TEST_P(LibraryFaultsTest, EachFaultIsNamed) {  // N8
  const std::vector<std::pair<Fault, Condition>> expected{
      {Fault::kUnplugged, Condition::kLost},
      {Fault::kStalled, Condition::kStale},
      {Fault::kNotANumber, Condition::kImplausible},
      {Fault::kJump, Condition::kImplausible},
      {Fault::kCalibrationLost, Condition::kNotCalibrated},
      {Fault::kForceRefused, Condition::kNoForce}};
  for (const auto& [fault, condition] : expected) {
    SCOPED_TRACE(ToString(fault));
    Rig rig(which(), profile());
    const Law push = [](const DeviceState&) {
      spatial::Wrench F;
      F.f.x() = 0.5;
      return F;
    };
    rig.Run(which().start_ms, push);
    rig.emulated().SetFault(fault);
    const DeviceState state = rig.Run(8, push);
    EXPECT_EQ(state.condition, condition);
    EXPECT_FALSE(rig.device().Explain(state).empty());
  }
}

TEST_P(LibraryFaultsTest, ForceThatNobodyRenewsEndsByItself) {  // N6
  Rig rig(which(), profile());
  spatial::Wrench F;
  F.f.y() = 1;
  rig.Run(which().start_ms + 10, [&](const DeviceState&) { return F; });
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.y(), 1, 1e-6);
  rig.emulator().Advance(120 * kTickNs);  // The haptic thread hangs.
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
  rig.Run(which().start_ms, [&](const DeviceState&) { return F; });
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.y(), 1, 1e-6);
}

TEST_P(LibraryFaultsTest, ClosingLeavesNoForce) {
  Rig rig(which(), profile());
  spatial::Wrench F;
  F.f.y() = 1;
  rig.Run(which().start_ms + 10, [&](const DeviceState&) { return F; });
  ASSERT_GT(rig.emulated().truth().F_H_D.f.norm(), 0.9);
  rig.Close();
  rig.emulator().Advance(2 * kTickNs);
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
  EXPECT_TRUE(OpenEmulated(which(), rig.emulator()).has_value());
}

TEST_P(LibraryFaultsTest, ADeviceCannotBeOpenedTwice) {
  Rig rig(which(), profile());
  EXPECT_FALSE(OpenEmulated(which(), rig.emulator()).has_value());
}

TEST_P(LibraryFaultsTest, AnUnpluggedDeviceIsNotOpenedAndSaysWhatToDo) {  // N8
  EmulatorOptions options;
  options.profile = profile();
  const auto emulator = StartCase(which(), options);
  emulator->device().SetFault(Fault::kUnplugged);
  const auto device = OpenEmulated(which(), *emulator);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().code, ErrorCode::kNotFound);
  EXPECT_FALSE(device.error().remedy.empty());
}

TEST_P(LibraryFaultsTest, TwoDevicesWorkAtOnceAndOneMayFail) {
  Rig left(which(), profile(), spatial::Pose(Vec3(0.01, 0, 0)));
  Rig right(which(), profile(), spatial::Pose(Vec3(0, 0.02, 0)));
  const auto push = [](const Vec3& f) {
    return [f](const DeviceState&) { return spatial::Wrench{Vec3::Zero(), f}; };
  };
  const auto both = [&](int ms) {
    for (int k = 0; k < ms; ++k) {
      left.Tick(push(Vec3(1, 0, 0)));
      right.Tick(push(Vec3(0, 0, 1)));
    }
  };
  both(which().start_ms);
  EXPECT_NEAR(left.emulated().truth().F_H_D.f.x(), 1, 1e-6);
  EXPECT_NEAR(right.emulated().truth().F_H_D.f.z(), 1, 1e-6);
  EXPECT_NEAR(left.device().Read().X_DH.p().x(), 0.01 + 1.0 / 400, 1e-3);
  EXPECT_NEAR(right.device().Read().X_DH.p().y(), 0.02, 1e-3);
  left.emulated().SetFault(Fault::kUnplugged);
  both(300);
  EXPECT_EQ(left.device().Read().condition, Condition::kLost);
  EXPECT_NEAR(right.emulated().truth().F_H_D.f.z(), 1, 1e-6);
  left.emulated().SetFault(Fault::kNone);
  both(which().start_ms + 400);
  EXPECT_NEAR(left.emulated().truth().F_H_D.f.x(), 1, 1e-6);
  left.Close();
  right.Run(10, push(Vec3(0, 0, 1)));
  EXPECT_NEAR(right.emulated().truth().F_H_D.f.z(), 1, 1e-6);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSchedules = 50;  // Sanitizers make the physics twenty times slower.
#else
constexpr std::uint64_t kSchedules = 500;
#endif

/** One schedule of faults at random times, with a hand that moves about. */
class Schedule {
 public:
  Schedule(const LibraryCase& which, const DeviceProfile& profile, std::uint64_t seed)
      : which_(which),
        random_(seed),
        rig_(which, profile),
        wall_(Wall(profile.max_stiffness, 2)),
        peak_(profile.max_force) {}

  void Run() {
    Calm();
    const int faults = 1 + static_cast<int>(random_.Uniform(0, 3));
    for (int k = 0; k < faults; ++k) {
      MoveHand();
      Watch(10 + static_cast<int>(random_.Uniform(0, 150)), Fault::kNone);
      const auto which_fault = static_cast<std::size_t>(random_.Uniform(0, kFaults.size()));
      const Fault fault = kFaults[which_fault];
      rig_.emulated().SetFault(fault);
      Watch(1 + static_cast<int>(random_.Uniform(0, 120)), fault);
      rig_.emulated().SetFault(Fault::kNone);
    }
    rig_.SetHand({});
    Calm();
  }

  /** Ticks in which the wall was felt, so that the faults had something to take away. */
  [[nodiscard]] int felt() const { return felt_; }

 private:
  /** It comes back by itself, in the time that it takes to start, and stays. */
  void Calm() {
    int ready_ms = 0;
    for (int ms = 0; ms < which_.start_ms + 600 && ready_ms < 250; ++ms) {
      ready_ms = rig_.Tick(wall_).condition == Condition::kReady ? ready_ms + 1 : 0;
    }
    ASSERT_EQ(ready_ms, 250);
  }

  void MoveHand() {
    HandIntent hand;
    hand.X_DR = spatial::Pose(Vec3(random_.Uniform(-0.012, 0.012), random_.Uniform(-0.02, 0.02),
                                   random_.Uniform(-0.02, 0.02)));
    rig_.SetHand(hand);
  }

  void Watch(int ms, Fault fault) {
    double last = 0;
    for (int k = 1; k <= ms; ++k) {
      const DeviceState state = rig_.Tick(wall_);
      const double force = rig_.emulated().truth().F_H_D.f.norm();
      ASSERT_TRUE(spatial::IsFinite(state.X_DH) && state.V_DH.v.allFinite());
      ASSERT_LE(force, peak_ + 1e-9);
      // A pose that has jumped and then stays is believed after a while.
      const bool shows_none = fault != Fault::kNone && fault != Fault::kSignFlipped &&
                              !(fault == Fault::kJump && k > 50);
      if (shows_none && k > 5) {
        ASSERT_LE(force, last + 1e-9) << ToString(fault) << " after " << k << " ms";
      }
      last = force;
      felt_ += force > 0.5 ? 1 : 0;
    }
  }

  const LibraryCase& which_;
  Random random_;
  Rig rig_;
  Law wall_;
  double peak_;
  int felt_{0};
};

TEST_P(LibraryFaultsTest, FiveHundredRandomSchedulesOfFaultsStaySafeAndEndWell) {  // N6, X4
  int felt = 0;
  for (std::uint64_t seed = 1; seed <= kSchedules; ++seed) {
    SCOPED_TRACE(seed);
    Schedule schedule(which(), ProfileNamed(which().profile), seed);
    schedule.Run();
    ASSERT_FALSE(HasFatalFailure());
    felt += schedule.felt();
  }
  EXPECT_GT(felt, 20 * static_cast<int>(kSchedules));
}

}  // namespace
}  // namespace hvas::device
