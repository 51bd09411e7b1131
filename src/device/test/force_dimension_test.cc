// The driver of Force Dimension: its units, order of calls, errors, and what a probe says (N8).

#include "device/drivers/force_dimension.h"

#include <unistd.h>

#include "device/test/library_probe_folder.h"
#include "device/test/library_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

DeviceProfile Sigma() {
  return WithoutFriction(ProfileNamed("sigma7"));
}

spatial::Wrench Push(const DeviceState& /*state*/) {
  return {Vec3::Zero(), Vec3(1, 0, 0)};
}

TEST(ForceDimensionTest, APoseIsByRowsAndInMetres) {
  const double rows[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};  // x goes to y.
  const spatial::Pose X = force_dimension::ToPose(Vec3(0.05, 0, -0.01), rows);
  EXPECT_EQ(X.p(), Vec3(0.05, 0, -0.01));
  EXPECT_LT((X.q() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(ForceDimensionTest, PoseVelocityGripperAndButtonsComeThrough) {
  const spatial::Pose X_DH(spatial::RotationFromVector(Vec3(0.1, 0.4, -0.3)),
                           Vec3(0.03, -0.01, 0.02));
  Rig rig(kForceDimension, Sigma(), X_DH);
  HandIntent hand;
  hand.X_DR = X_DH;
  hand.grip = 0.75;
  rig.SetHand(hand);
  DeviceState state = rig.Run(400);
  EXPECT_EQ(state.condition, Condition::kReady);
  EXPECT_LT((state.X_DH.p() - X_DH.p()).norm(), 1e-5);
  EXPECT_LT(spatial::RotationBetween(state.X_DH.q(), X_DH.q()).norm(), 1e-3);
  EXPECT_NEAR(state.grip, 0.75, 1e-12);
  EXPECT_TRUE(state.is_gripping);
  hand.grip = 0.25;
  hand.V_DR.w = Vec3(0, 0, 0.5);
  hand.turn_stiffness = 0;
  hand.turn_damping = 10;
  rig.SetHand(hand);
  state = rig.Run(100);
  EXPECT_FALSE(state.is_gripping);
  EXPECT_NEAR(state.V_DH.w.z(), 0.5, 0.05);
}

TEST(ForceDimensionTest, OnlyAnActiveWristShowsTorques) {
  Rig sigma(kForceDimension, ProfileNamed("sigma7"));
  EXPECT_EQ(sigma.device().info().capabilities.torque_axes, 3);
  EXPECT_GT(sigma.device().info().profile.max_torque, 0);
  Rig omega(kForceDimension, ProfileNamed("omega7"));
  EXPECT_EQ(omega.device().info().model, "omega.7");
  EXPECT_EQ(omega.device().info().capabilities.torque_axes, 0);
  EXPECT_TRUE(omega.device().info().capabilities.has_grip);
  Rig falcon(kForceDimension, ProfileNamed("falcon"));
  EXPECT_EQ(falcon.device().info().model, "Falcon");
  EXPECT_FALSE(falcon.device().info().capabilities.has_grip);
}

TEST(ForceDimensionTest, ASampleThatIsReusedIsNoError) {
  Rig rig(kForceDimension, Sigma());
  rig.Run(400);
  for (int k = 0; k < 5; ++k) {  // Asked again at the same time: TimeGuard answers.
    EXPECT_EQ(rig.device().Read().condition, Condition::kReady);
  }
}

TEST(ForceDimensionTest, ASampleThatIsReusedKeepsItsTime) {
  Rig rig(kForceDimension, Sigma());
  const DeviceState last = rig.Run(400);
  EXPECT_EQ(last.sample_ns, last.t_ns);
  rig.emulated().SetFault(Fault::kStalled);
  const DeviceState again = rig.Run(2);
  EXPECT_EQ(again.sample_ns, last.sample_ns);
  EXPECT_GT(again.t_ns, last.t_ns);
  rig.emulated().SetFault(Fault::kNone);
  const DeviceState next = rig.Run(1);
  EXPECT_EQ(next.sample_ns, next.t_ns);
}

TEST(ForceDimensionTest, TheVendorsWatchdogCutsForceWithin20MillisecondsAndIsRecoveredFrom) {
  Rig rig(kForceDimension, Sigma());
  rig.Run(400, Push);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-9);
  rig.emulator().Advance(15 * kTickNs);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-9);
  rig.emulator().Advance(8 * kTickNs);
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
  const DeviceState state = rig.Tick(Push);
  EXPECT_EQ(state.condition, Condition::kNoForce);
  EXPECT_NE(rig.device().Explain(state).find("watchdog"), std::string::npos);
  rig.Run(400, Push);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-9);
}

TEST(ForceDimensionTest, ForceThatWasCutIsEnabledAgainAndRamped) {
  Rig rig(kForceDimension, Sigma());
  rig.Run(400, Push);
  rig.emulated().SetFault(Fault::kForceRefused);
  const DeviceState state = rig.Run(3, Push);
  EXPECT_EQ(state.condition, Condition::kNoForce);
  EXPECT_EQ(state.vendor_code, -force_dimension::kOffByVelocity);
  rig.emulated().SetFault(Fault::kNone);
  double last = 0;
  for (int ms = 0; ms < 500; ++ms) {
    rig.Tick(Push);
    const double force = rig.emulated().truth().F_H_D.f.x();
    EXPECT_LE(std::abs(force - last), 0.0051) << ms;
    last = force;
  }
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(ForceDimensionTest, ErrorsAreJudgedByTheirClass) {
  using force_dimension::Judge;
  EXPECT_EQ(Judge(0), VendorVerdict::kFine);
  for (const int error : {2, 4, 5, 7}) {
    EXPECT_EQ(Judge(error), VendorVerdict::kGone) << error;
  }
  EXPECT_EQ(Judge(12), VendorVerdict::kNotCalibrated);
  EXPECT_EQ(Judge(8), VendorVerdict::kFault);
}

TEST(ForceDimensionTest, ADeviceIsCalibratedWhenItIsOpenedButNotByAProbe) {
  EmulatorOptions options;
  options.profile = Sigma();
  LibraryManners manners;
  manners.is_calibrated = false;
  const auto emulator = StartCase(kForceDimension, options, manners);
  const ProbeReport report = ForceDimensionDriver().Probe(emulator->surroundings(), true);
  EXPECT_TRUE(report.devices.empty());
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message, "sigma.7 is not calibrated");
  EXPECT_NE(report.problems[0].remedy.find("keep your hands off"), std::string::npos);
  EXPECT_TRUE(OpenEmulated(kForceDimension, *emulator).has_value());

  manners.can_calibrate = false;
  const auto stubborn = StartCase(kForceDimension, options, manners);
  const auto device = OpenEmulated(kForceDimension, *stubborn);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().message, "sigma.7 could not calibrate itself");
}

TEST(ForceDimensionTest, AProbeNamesWhatIsThere) {
  EmulatorOptions options;
  options.profile = Sigma();
  const auto emulator = StartCase(kForceDimension, options);
  const ProbeReport report = ForceDimensionDriver().Probe(emulator->surroundings(), true);
  ASSERT_EQ(report.devices.size(), 1U);
  EXPECT_TRUE(report.problems.empty());
  EXPECT_EQ(report.devices[0].model, "sigma.7");
  EXPECT_EQ(report.devices[0].version, "3.17.5");
  EXPECT_EQ(report.devices[0].address, "0");
  EXPECT_TRUE(report.devices[0].is_emulated);
  emulator->device().SetFault(Fault::kUnplugged);
  const ProbeReport unplugged = ForceDimensionDriver().Probe(emulator->surroundings(), true);
  ASSERT_EQ(unplugged.problems.size(), 1U);
  EXPECT_EQ(unplugged.problems[0].message,
            "device 0 of Force Dimension could not be opened: no device responds; check its "
            "cable and power (its error 5)");
}

TEST(ForceDimensionTest, AnAddressThatIsNoNumberIsRefused) {
  EmulatorOptions options;
  options.profile = Sigma();
  const auto emulator = StartCase(kForceDimension, options);
  for (const char* address : {"left", "-1", "99", "0x"}) {
    const auto device = ForceDimensionDriver().Open(address, emulator->surroundings());
    ASSERT_FALSE(device.has_value()) << address;
    EXPECT_EQ(device.error().code, ErrorCode::kInvalid) << address;
  }
}

TEST(ForceDimensionTest, AMachineWithoutAnythingExplainsItself) {
  const ProbeFolder machine;
  const ProbeReport report = ForceDimensionDriver().Probe(machine.surroundings(), true);
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message,
            "the library of Force Dimension (DHD/DRD) (libdrd.so.3*, libdrd.so) is not "
            "installed");
  EXPECT_NE(report.problems[0].remedy.find("FORCEDIM_SDK"), std::string::npos);
  EXPECT_TRUE(HasFinding(report, "USB device 1451:* of Force Dimension", false));
}

TEST(ForceDimensionTest, ADeviceThatThisUserMayNotUseComesWithTheRuleThatMendsIt) {
  const ProbeFolder machine;
  machine.AddUsb("1-4", "1451", "0402", "omega.7", 2, 11);
  const std::string node = machine.Path("dev/bus/usb/002/011");
  std::filesystem::permissions(node, std::filesystem::perms::none);
  // Root may use everything, and looks with the eyes of somebody else.
  constexpr uid_t kNobody = 65534;
  const bool is_root = ::geteuid() == 0;
  ASSERT_TRUE(!is_root || ::seteuid(kNobody) == 0);
  const ProbeReport report = ForceDimensionDriver().Probe(machine.surroundings(), false);
  ASSERT_TRUE(!is_root || ::seteuid(0) == 0);
  ASSERT_GE(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message,
            "USB device 1451:0402 of Force Dimension may not be used by this user");
  EXPECT_EQ(report.problems[0].where, node);
  EXPECT_EQ(report.problems[0].remedy,
            "as root, put the line SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1451\", MODE=\"0666\" "
            "into /etc/udev/rules.d/60-hvas-1451.rules, run \"udevadm control --reload\", and "
            "connect the device again");
}

}  // namespace
}  // namespace hvas::device
