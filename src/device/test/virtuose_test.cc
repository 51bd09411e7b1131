// The driver of Haption's Virtuose: its units, order of calls, errors, and what a probe says (N8).

#include "device/drivers/virtuose.h"

#include "device/test/library_probe_folder.h"
#include "device/test/library_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

DeviceProfile Virtuose() {
  return WithoutFriction(ProfileNamed("virtuose"));
}

spatial::Wrench Push(const DeviceState& /*state*/) {
  return {Vec3(0, 0.2, 0), Vec3(1, 0, 0)};
}

TEST(VirtuoseTest, AQuaternionHasItsScalarLast) {
  const float half = std::sqrt(0.5F);
  const spatial::Pose X = virtuose::ToPose({0.25F, -0.5F, 1, 0, 0, half, half});  // x goes to y.
  EXPECT_EQ(X.p(), Vec3(0.25, -0.5, 1));
  EXPECT_LT((X.q() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-7);
}

TEST(VirtuoseTest, SpeedsAndForcesHaveTheLinearPartFirst) {
  const spatial::Twist V = virtuose::ToTwist({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(V.v, Vec3(1, 2, 3));
  EXPECT_EQ(V.w, Vec3(4, 5, 6));
  const auto force = virtuose::FromWrench({Vec3(4, 5, 6), Vec3(1, 2, 3)});
  EXPECT_EQ(force, (std::array<float, 6>{1, 2, 3, 4, 5, 6}));
}

TEST(VirtuoseTest, PoseAndButtonsComeThrough) {
  const spatial::Pose X_DH(spatial::RotationFromVector(Vec3(-0.2, 0.6, 0.1)),
                           Vec3(0.1, 0.05, -0.15));
  Rig rig(kVirtuose, Virtuose(), X_DH);
  HandIntent hand;
  hand.X_DR = X_DH;
  hand.buttons = 0b10;
  rig.SetHand(hand);
  const DeviceState state = rig.Run(3100);
  EXPECT_EQ(state.condition, Condition::kReady);
  EXPECT_LT((state.X_DH.p() - X_DH.p()).norm(), 1e-5);
  EXPECT_LT(spatial::RotationBetween(state.X_DH.q(), X_DH.q()).norm(), 2e-4);
  EXPECT_FALSE(state.is_gripping);
  EXPECT_TRUE(state.is_clutching);
}

TEST(VirtuoseTest, ForceWaitsForTheRelays) {
  Rig rig(kVirtuose, Virtuose());
  EXPECT_EQ(rig.Run(2900, Push).condition, Condition::kNoForce);
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
  EXPECT_EQ(rig.Run(500, Push).condition, Condition::kReady);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-6);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.t.y(), 0.2, 1e-6);
}

TEST(VirtuoseTest, TheDeadManSwitchAndTheEmergencyStopTakeTheForce) {
  Rig rig(kVirtuose, Virtuose());
  rig.Run(3400, Push);
  HandIntent hand;
  hand.is_holding = false;
  rig.SetHand(hand);
  DeviceState state = rig.Run(3, Push);
  EXPECT_EQ(state.condition, Condition::kNotHeld);
  EXPECT_EQ(rig.emulated().truth().F_H_D.f.norm(), 0);
  hand.is_holding = true;
  rig.SetHand(hand);
  EXPECT_EQ(rig.Run(400, Push).condition, Condition::kReady);
  EXPECT_NEAR(rig.emulated().truth().F_H_D.f.x(), 1, 1e-6);
  hand.is_stopped = true;
  rig.SetHand(hand);
  state = rig.Run(3, Push);
  EXPECT_EQ(state.condition, Condition::kStopped);
  EXPECT_FALSE(state.is_valid);
  EXPECT_EQ(rig.emulated().truth().command.f.norm(), 0);
}

TEST(VirtuoseTest, ADiscontinuityIsNotBelieved) {
  Rig rig(kVirtuose, Virtuose());
  rig.Run(3400, Push);
  rig.emulated().SetFault(Fault::kJump);
  DeviceState state = rig.Run(100, Push);  // Longer than a jump alone is doubted.
  EXPECT_EQ(state.condition, Condition::kImplausible);
  EXPECT_EQ(state.vendor_code, virtuose::kErrorDiscontinuity);
  EXPECT_NE(rig.device().Explain(state).find("detected a jump of its pose"), std::string::npos);
  rig.emulated().SetFault(Fault::kNone);
  EXPECT_EQ(rig.Run(200, Push).condition, Condition::kReady);
}

TEST(VirtuoseTest, ErrorsAndAlarmsAreJudgedByTheirClass) {
  using virtuose::Judge;
  using virtuose::JudgeAlarms;
  EXPECT_EQ(Judge(0), VendorVerdict::kFine);
  EXPECT_EQ(Judge(2), VendorVerdict::kGone);
  EXPECT_EQ(Judge(6), VendorVerdict::kGone);
  EXPECT_EQ(Judge(11), VendorVerdict::kFault);
  EXPECT_EQ(Judge(12), VendorVerdict::kImplausible);
  EXPECT_EQ(JudgeAlarms(0x4000), VendorVerdict::kRefuses);
  EXPECT_EQ(JudgeAlarms(0x8000 | 0x20000), VendorVerdict::kFine);
  EXPECT_EQ(JudgeAlarms(0x40000 | 0x4000), VendorVerdict::kNotCalibrated);
}

TEST(VirtuoseTest, AProbeNamesTheController) {
  EmulatorOptions options;
  options.profile = Virtuose();
  const auto emulator = StartCase(kVirtuose, options);
  const ProbeReport report = VirtuoseDriver().Probe(emulator->surroundings(), true);
  ASSERT_EQ(report.devices.size(), 1U);
  EXPECT_TRUE(report.problems.empty());
  EXPECT_EQ(report.devices[0].model, "Virtuose 6D (type 0)");
  EXPECT_EQ(report.devices[0].version, "4.04");
  EXPECT_TRUE(report.devices[0].is_emulated);
}

TEST(VirtuoseTest, AControllerOfAnotherVersionIsNamed) {
  EmulatorOptions options;
  options.profile = Virtuose();
  LibraryManners manners;
  manners.is_of_this_version = false;
  const auto emulator = StartCase(kVirtuose, options, manners);
  const auto device = OpenEmulated(kVirtuose, *emulator);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(device.error().message.find("library and controller have different versions"),
            std::string::npos);
}

TEST(VirtuoseTest, ALibraryOfVersion3IsToldFromAForeignOne) {
  const ProbeFolder machine;
  Surroundings surroundings = machine.surroundings();
  surroundings.library_folders = {StubFolder() / "version3"};
  const auto device = VirtuoseDriver().Open("", surroundings);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(device.error().message,
            "the library of Haption Virtuose (VirtuoseAPI 4) has version 3; 4.x is needed");
  EXPECT_EQ(device.error().where, (StubFolder() / "version3/virtuoseAPI.so").string());
}

TEST(VirtuoseTest, AMachineWithoutAnythingExplainsItself) {
  const ProbeFolder machine;
  const ProbeReport report = VirtuoseDriver().Probe(machine.surroundings(), false);
  ASSERT_EQ(report.problems.size(), 1U);
  EXPECT_EQ(report.problems[0].message,
            "the library of Haption Virtuose (VirtuoseAPI 4) (virtuoseAPI.so) is not "
            "installed");
  EXPECT_NE(report.problems[0].remedy.find("VIRTUOSE_API"), std::string::npos);
}

}  // namespace
}  // namespace hvas::device
