// The driver of OpenHaptics: its units, order of calls, errors, and what a probe says (N8).

#include "device/drivers/openhaptics.h"

#include <fstream>

#include "device/drivers/usb_nodes.h"
#include "device/test/library_probe_folder.h"
#include "device/test/library_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

DeviceProfile TouchX() {
  return WithoutFriction(ProfileNamed("touch_x"));
}

TEST(OpenHapticsTest, APoseIsByColumnsAndInMillimetres) {
  // A quarter turn about z: x goes to y. 50 mm, -20 mm, 3 mm.
  const spatial::Pose X =
      openhaptics::ToPose({0, 1, 0, 0, /**/ -1, 0, 0, 0, /**/ 0, 0, 1, 0, /**/ 50, -20, 3, 1});
  EXPECT_LT((X.p() - Vec3(0.05, -0.02, 0.003)).norm(), 1e-15);
  EXPECT_LT((X.q() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(OpenHapticsTest, PoseVelocityAndButtonsComeThrough) {
  const Vec3 turn(0.3, -0.2, 0.5);
  const spatial::Pose X_DH(spatial::RotationFromVector(turn), Vec3(0.05, 0.01, -0.02));
  Rig rig(kOpenHaptics, TouchX(), X_DH);
  HandIntent hand;
  hand.X_DR = X_DH;
  hand.buttons = 0b11;
  rig.SetHand(hand);
  const DeviceState state = rig.Run(400);
  EXPECT_EQ(state.condition, Condition::kReady);
  EXPECT_LT((state.X_DH.p() - X_DH.p()).norm(), 2e-5);
  EXPECT_LT(spatial::RotationBetween(state.X_DH.q(), X_DH.q()).norm(), 1e-3);
  EXPECT_EQ(state.buttons, 0b11U);
  EXPECT_TRUE(state.is_gripping);
  EXPECT_TRUE(state.is_clutching);
  hand.V_DR.v = Vec3(0, 0.1, 0);
  hand.stiffness = 0;
  hand.damping = 1000;
  rig.SetHand(hand);
  EXPECT_NEAR(rig.Run(100).V_DH.v.y(), 0.1, 5e-3);
}

TEST(OpenHapticsTest, TheDeviceTellsItsLimits) {
  DeviceProfile profile = TouchX();
  profile.max_force = 6.5;
  profile.continuous_force = 1.25;
  profile.max_stiffness = 800;
  profile.workspace = Vec3(0.2, 0.1, 0.08);
  Rig rig(kOpenHaptics, profile);
  const DeviceInfo& info = rig.device().info();
  EXPECT_EQ(info.driver, "openhaptics");
  EXPECT_EQ(info.model, "PHANTOM Desktop");
  EXPECT_TRUE(info.is_emulated);
  EXPECT_NEAR(info.profile.max_force, 6.5, 1e-12);
  EXPECT_NEAR(info.profile.continuous_force, 1.25, 1e-12);
  EXPECT_NEAR(info.profile.max_stiffness, 800, 1e-9);
  EXPECT_LT((info.profile.workspace - Vec3(0.2, 0.1, 0.08)).norm(), 1e-12);
  EXPECT_EQ(info.profile_note,
            "figures of 3D Systems Touch X (PHANTOM Desktop); read from the device: peak force, "
            "continuous force, stiffness, rate, workspace");
}

TEST(OpenHapticsTest, APremiumWithSixAxesShowsForcesOnly) {
  Rig rig(kOpenHaptics, ProfileNamed("premium15"));
  const DeviceInfo& info = rig.device().info();
  EXPECT_EQ(info.capabilities.force_axes, 3);
  EXPECT_EQ(info.capabilities.torque_axes, 0);
  EXPECT_EQ(info.profile.max_torque, 0);
  EXPECT_NE(info.profile_note.find("its torques are not used"), std::string::npos);
}

TEST(OpenHapticsTest, AStylusThatNobodyHoldsIsGivenNoForce) {
  Rig rig(kOpenHaptics, TouchX());
  EXPECT_TRUE(rig.device().info().capabilities.has_presence_switch);
  const Law push = [](const DeviceState&) { return spatial::Wrench{Vec3::Zero(), Vec3(1, 0, 0)}; };
  rig.Run(400, push);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-9);
  HandIntent hand;
  hand.is_holding = false;
  rig.SetHand(hand);
  const DeviceState state = rig.Run(5, push);
  EXPECT_EQ(state.condition, Condition::kNotHeld);
  EXPECT_TRUE(state.is_valid);
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
}

TEST(OpenHapticsTest, AfterARefusalForceComesBackAlongARamp) {
  Rig rig(kOpenHaptics, TouchX());
  const Law push = [](const DeviceState&) { return spatial::Wrench{Vec3::Zero(), Vec3(1, 0, 0)}; };
  rig.Run(400, push);
  rig.emulated().SetFault(Fault::kForceRefused);
  DeviceState state = rig.Run(3, push);
  EXPECT_EQ(state.condition, Condition::kNoForce);
  rig.emulated().SetFault(Fault::kNone);
  state = rig.Run(10, push);
  EXPECT_EQ(state.condition, Condition::kNoForce);  // A pause first.
  double last = 0;
  for (int ms = 0; ms < 400; ++ms) {
    rig.Tick(push);
    const double force = rig.emulated().truth().F_H_D.f.x();
    EXPECT_LE(std::abs(force - last), 0.0051) << ms;  // 1 N in 200 ms.
    last = force;
  }
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(OpenHapticsTest, ErrorsAreJudgedByTheirClass) {
  using openhaptics::Judge;
  EXPECT_EQ(Judge(0), VendorVerdict::kFine);
  for (std::uint32_t error = 0x0200; error <= 0x0204; ++error) {
    EXPECT_EQ(Judge(error), VendorVerdict::kRefuses) << error;
  }
  for (const std::uint32_t error : {0x0300U, 0x0302U, 0x0304U}) {
    EXPECT_EQ(Judge(error), VendorVerdict::kGone) << error;
  }
  EXPECT_EQ(Judge(0x0301), VendorVerdict::kFine);
  EXPECT_EQ(Judge(0x0402), VendorVerdict::kFault);
  EXPECT_EQ(Judge(0x0600), VendorVerdict::kFault);
}

TEST(OpenHapticsTest, AProbeStartsTheDeviceAndLetsGo) {
  EmulatorOptions options;
  options.profile = TouchX();
  const auto emulator = StartCase(kOpenHaptics, options);
  const ProbeReport report = OpenHapticsDriver().Probe(emulator->surroundings(), true);
  ASSERT_EQ(report.devices.size(), 1U);
  EXPECT_EQ(report.devices[0].model, "PHANTOM Desktop");
  EXPECT_TRUE(report.problems.empty());
  EXPECT_EQ(emulator->device().truth().commands, 1U);  // The zero that it leaves behind.
  EXPECT_TRUE(OpenEmulated(kOpenHaptics, *emulator).has_value());
}

TEST(OpenHapticsTest, AProbeThatOnlyLooksOpensNothing) {
  EmulatorOptions options;
  options.profile = TouchX();
  const auto emulator = StartCase(kOpenHaptics, options);
  const ProbeReport report = OpenHapticsDriver().Probe(emulator->surroundings(), false);
  EXPECT_TRUE(report.devices.empty());
  EXPECT_TRUE(report.problems.empty());
  EXPECT_TRUE(HasFinding(report, "libHD.so", true));
  EXPECT_EQ(emulator->device().truth().commands, 0U);
}

TEST(OpenHapticsTest, ALicenceThatIsMissingIsNamed) {
  EmulatorOptions options;
  options.profile = TouchX();
  LibraryManners manners;
  manners.is_licensed = false;
  const auto emulator = StartCase(kOpenHaptics, options, manners);
  const ProbeReport report = OpenHapticsDriver().Probe(emulator->surroundings(), true);
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message,
            "the first device of OpenHaptics could not be started: OpenHaptics has no valid "
            "licence (its error 0x0600)");
  EXPECT_NE(report.problems[0].remedy.find("licence"), std::string::npos);
}

TEST(OpenHapticsTest, ADeviceCalibratesItselfOrSaysHow) {
  LibraryManners manners;
  manners.is_calibrated = false;
  Rig rig(kOpenHaptics, TouchX(), {}, manners);
  EXPECT_EQ(rig.Run(400).condition, Condition::kReady);
  EmulatorOptions options;
  options.profile = TouchX();
  manners.can_calibrate = false;
  const auto emulator = StartCase(kOpenHaptics, options, manners);
  const auto device = OpenEmulated(kOpenHaptics, *emulator);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().message, "PHANTOM Desktop is not calibrated");
  EXPECT_EQ(device.error().remedy, "put its stylus into the inkwell, and try again");
}

TEST(OpenHapticsTest, AMachineWithoutAnythingExplainsItself) {
  const ProbeFolder machine;
  for (const bool opens : {false, true}) {
    const ProbeReport report = OpenHapticsDriver().Probe(machine.surroundings(), opens);
    EXPECT_EQ(report.driver, "openhaptics");
    ASSERT_EQ(report.problems.size(), 1U);
    EXPECT_EQ(report.problems[0].code, ErrorCode::kNotFound);
    EXPECT_EQ(report.problems[0].message,
              "the library of OpenHaptics (3D Systems) (libHD.so.3*, libHD.so) is not "
              "installed");
    EXPECT_NE(report.problems[0].where.find(machine.Path("usr/lib")), std::string::npos);
    EXPECT_NE(report.problems[0].remedy.find("GTDD_HOME"), std::string::npos);
    EXPECT_TRUE(HasFinding(report, "libHD.so", false));
    EXPECT_TRUE(HasFinding(report, "USB device 2988:* of 3D Systems", false));
  }
}

TEST(OpenHapticsTest, ATouchOnUsbIsFoundWithoutTheLibrary) {
  ProbeFolder machine;
  machine.AddUsb("1-2", "2988", "0302", "3D Systems Touch", 1, 7);
  const ProbeReport report = OpenHapticsDriver().Probe(machine.surroundings(), false);
  ASSERT_FALSE(report.looked_for.empty());
  EXPECT_EQ(report.looked_for[0].what, "USB device 2988:0302");
  EXPECT_EQ(report.looked_for[0].where, machine.Path("dev/bus/usb/001/007"));
  EXPECT_EQ(report.looked_for[0].note, "3D Systems Touch, may be used");
  EXPECT_TRUE(report.looked_for[0].is_found);
}

}  // namespace
}  // namespace hvas::device
