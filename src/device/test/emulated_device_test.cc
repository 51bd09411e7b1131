#include "device/emulation/emulated_device.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "device/driver.h"
#include "device/emulation/emulator.h"
#include "device/test/tick_time.h"

namespace hvas::device {
namespace {

using testing::kTickNs;

DeviceProfile WithoutFriction() {
  DeviceProfile profile;
  profile.friction = 0;
  profile.rotational_friction = 0;
  profile.damping = 0;
  profile.rotational_damping = 0;
  return profile;
}

TEST(EmulatedDeviceTest, AConstantForceAcceleratesTheMassAlone) {  // v = F t / m
  EmulatedDevice device(WithoutFriction());
  spatial::Wrench F;
  F.f = Vec3(0.5, 0, 0);
  device.Command(F);
  device.Advance(50 * kTickNs);
  const auto truth = device.truth();
  EXPECT_NEAR(truth.V_DH.v.x(), 0.5 * 0.05 / device.profile().mass, 1e-9);
  // Work is kinetic energy, to the order of the step.
  const double kinetic = 0.5 * device.profile().mass * truth.V_DH.v.squaredNorm();
  EXPECT_NEAR(truth.work, kinetic, 5e-3 * kinetic);
}

TEST(EmulatedDeviceTest, DryFrictionHoldsWhatIsBelowIt) {
  DeviceProfile profile;
  EmulatedDevice device(profile);
  spatial::Wrench F;
  F.f = Vec3(0, 0.9 * profile.friction, 0);
  device.Command(F);
  device.Advance(100 * kTickNs);
  EXPECT_EQ(device.truth().X_DH.p().norm(), 0);
  F.f *= 2;
  device.Command(F);
  device.Advance(100 * kTickNs);
  EXPECT_GT(device.truth().X_DH.p().y(), 1e-3);
}

TEST(EmulatedDeviceTest, TheHandHoldsAgainstAForceByItsStiffness) {  // x = F / k
  EmulatedDevice device(WithoutFriction());
  HandIntent hand;
  device.SetHand(hand);
  spatial::Wrench F;
  F.f = Vec3(0, 0, 2);
  F.t = Vec3(0.1, 0, 0);
  device.Command(F);
  device.Advance(2000 * kTickNs);
  EXPECT_NEAR(device.truth().X_DH.p().z(), 2 / hand.stiffness, 1e-6);
  EXPECT_NEAR(spatial::RotationVector(device.truth().X_DH.q()).x(), 0.1 / hand.turn_stiffness,
              1e-6);
}

TEST(EmulatedDeviceTest, MotorsHaveLimitsAndEncodersHaveSteps) {
  DeviceProfile profile;
  EmulatedDevice device(profile);
  device.SetHand({});
  spatial::Wrench F;
  F.f = Vec3(300, 0, 400);
  device.Command(F);
  device.Advance(20 * kTickNs);
  EXPECT_NEAR(device.truth().F_H_D.f.norm(), profile.max_force, 1e-12);
  const EmulatedSample sample = device.Sense();
  const double steps = sample.X_DH.p().x() / profile.position_resolution;
  EXPECT_NEAR(steps, std::round(steps), 1e-6);
  EXPECT_NEAR((sample.X_DH.p() - device.truth().X_DH.p()).cwiseAbs().maxCoeff(), 0,
              0.5 * profile.position_resolution + 1e-12);
}

TEST(EmulatedDeviceTest, ADelayedCommandArrivesLater) {
  EmulatedDevice device{DeviceProfile()};
  device.SetDelay(5 * kTickNs);
  spatial::Wrench F;
  F.f = Vec3(1, 0, 0);
  device.Command(F);
  device.Advance(5 * kTickNs);
  EXPECT_EQ(device.truth().F_H_D.f.x(), 0);
  device.Advance(kTickNs);
  EXPECT_EQ(device.truth().F_H_D.f.x(), 1);
  device.SetCommandTimeout(10 * kTickNs);
  device.Advance(10 * kTickNs);
  EXPECT_EQ(device.truth().F_H_D.f.x(), 0);
}

TEST(EmulatedDeviceTest, EachFaultShowsItselfAndEnds) {
  for (const Fault fault : kFaults) {
    SCOPED_TRACE(ToString(fault));
    EmulatedDevice device{DeviceProfile()};
    HandIntent hand;
    hand.X_DR = spatial::Pose(Vec3(0.02, 0, 0));
    device.SetHand(hand);
    device.Advance(20 * kTickNs);
    const EmulatedSample before = device.Sense();
    device.SetFault(fault);
    spatial::Wrench F;
    F.f = Vec3(-1, 0, 0);
    device.Command(F);
    device.Advance(5 * kTickNs);
    const EmulatedSample during = device.Sense();
    const auto truth = device.truth();
    EXPECT_EQ(during.fault, fault);
    const bool is_silent = fault == Fault::kUnplugged || fault == Fault::kStalled;
    EXPECT_EQ(during.sequence == before.sequence, is_silent);
    EXPECT_EQ(during.X_DH.p().allFinite(), fault != Fault::kNotANumber);
    EXPECT_EQ((during.X_DH.p() - truth.X_DH.p()).norm() > 0.07, fault == Fault::kJump);
    const double force = truth.F_H_D.f.x();
    const bool is_slack = fault == Fault::kUnplugged || fault == Fault::kForceRefused;
    EXPECT_EQ(force, is_slack ? 0 : fault == Fault::kSignFlipped ? 1 : -1);
    device.SetFault(Fault::kNone);
    device.Advance(20 * kTickNs);
    EXPECT_GT(device.Sense().sequence, during.sequence);
    EXPECT_NEAR((device.Sense().X_DH.p() - device.truth().X_DH.p()).norm(), 0, 1e-4);
  }
}

TEST(Emulators, EveryDriverHasOne) {
  std::vector<std::string> drivers;
  for (const Driver* driver : Drivers()) {
    drivers.emplace_back(driver->name());
  }
  EXPECT_EQ(EmulatedDrivers(), drivers);
}

}  // namespace
}  // namespace hvas::device
