// SpaceMouse and gamepad: rate control, what is sent, faults, probing (X5, N8).
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include <fcntl.h>
#include <linux/uinput.h>

#include "base/test/temporary_folder.h"
#include "device/drivers/evdev_node.h"
#include "device/drivers/rate_control.h"
#include "device/drivers/spacenav_protocol.h"
#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using hvas::testing::TemporaryFolder;
using testing::kTickNs;
using testing::OptionsOf;
using testing::WireRig;

TEST(RateControlTest, SmallDeflectionsDoNothingAndFullOnesMoveAtFullSpeed) {
  RateControl rate(Vec3(1, 1, 1));
  rate.Step({Vec3(0.9 * RateControl::kDeadZone, 0, 0), Vec3(0, 0, 0.05)}, 0.01);
  EXPECT_EQ(rate.V_DH().v.norm() + rate.V_DH().w.norm(), 0);
  for (int i = 0; i < 100; ++i) {
    rate.Step({Vec3(0, 2, 0), Vec3(0, 0, -2)}, 0.01);
  }
  EXPECT_NEAR(rate.X_DH().p().y(), RateControl::kMaxSpeed, 1e-12);
  EXPECT_NEAR(spatial::RotationVector(rate.X_DH().q()).z(), -RateControl::kMaxTurnRate, 1e-12);
}

TEST(RateControlTest, SpeedGrowsWithTheDeflectionAndKeepsItsDirection) {
  double before = 0;
  for (int step = 0; step <= 100; ++step) {
    const double share =
        RateControl::Response(RateControl::kDeadZone + (1 - RateControl::kDeadZone) * step / 100);
    EXPECT_GE(share, before);
    before = share;
  }
  EXPECT_NEAR(RateControl::Response(1), 1, 1e-12);
  RateControl rate(Vec3(1, 1, 1));
  rate.Step({Vec3(0.3, -0.4, 0), Vec3::Zero()}, 0.01);
  EXPECT_NEAR(rate.V_DH().v.x() / rate.V_DH().v.y(), -0.75, 1e-12);
}

TEST(RateControlTest, X5ThePoseStaysInItsBoxAndAfterAPauseNothingLeaps) {
  RateControl rate(Vec3(0.2, 0.1, 0.3));
  for (int i = 0; i < 1000; ++i) {
    rate.Step({Vec3(1, -1, 1), Vec3::Zero()}, 0.01);
  }
  EXPECT_EQ(rate.X_DH().p(), Vec3(0.1, -0.05, 0.15));
  EXPECT_LT(rate.V_DH().v.norm(), 1e-12);
  RateControl other(Vec3(10, 10, 10));
  other.Step({Vec3(1, 0, 0), Vec3::Zero()}, 100);
  EXPECT_LT(other.X_DH().p().x(), 0.02);
}

TEST(SpacenavTest, FramesAndDeflectionsAreTheSameThing) {
  const spacenav::Frame frame{spacenav::kMotion, 35, 70, 105, -35, -70, -105, 8};
  const Deflection deflection = spacenav::DeflectionOf(frame);
  EXPECT_LT((deflection.move - Vec3(0.1, 0.3, 0.2)).norm(), 1e-12);  // right, away, up
  EXPECT_LT((deflection.turn - Vec3(-0.1, -0.3, -0.2)).norm(), 1e-12);
  EXPECT_EQ(spacenav::FrameOf(deflection), frame);
}

struct Case {
  const Driver& (*driver)();
  const char* name;
};

class RateDeviceTest : public ::testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] const Driver& driver() const { return GetParam().driver(); }
};

HandIntent Wanting(const spatial::Pose& X_DR) {
  HandIntent hand;
  hand.X_DR = X_DR;
  return hand;
}

TEST_P(RateDeviceTest, X5APersonBringsThePoseToWhereItShouldBe) {
  WireRig rig(driver(), OptionsOf(GetParam().name));
  ASSERT_TRUE(rig.is_open());
  const DeviceInfo& info = rig.device().info();
  EXPECT_TRUE(info.is_emulated);
  EXPECT_EQ(info.capabilities.force_axes + info.capabilities.torque_axes, 0);
  EXPECT_FALSE(info.capabilities.senses_position);
  const spatial::Pose X_DR(spatial::RotationFromVector(Vec3(0.2, 0, -0.4)),
                           Vec3(0.05, -0.03, 0.04));
  rig.hardware().SetHand(Wanting(X_DR));
  const DeviceState state = rig.Run(3000);
  EXPECT_EQ(state.condition, Condition::kReady);
  EXPECT_LT((state.X_DH.p() - X_DR.p()).norm(), 1e-3);
  EXPECT_LT(spatial::RotationBetween(state.X_DH.q(), X_DR.q()).norm(), 0.13);  // shoulders: coarse
}

TEST_P(RateDeviceTest, ButtonsGripAndClutch) {
  WireRig rig(driver(), OptionsOf(GetParam().name));
  ASSERT_TRUE(rig.is_open());
  HandIntent hand;
  hand.buttons = 1;
  rig.hardware().SetHand(hand);
  DeviceState state = rig.Run(40);
  EXPECT_TRUE(state.is_gripping && !state.is_clutching);
  hand.buttons = 2;
  rig.hardware().SetHand(hand);
  state = rig.Run(40);
  EXPECT_TRUE(!state.is_gripping && state.is_clutching);
}

TEST_P(RateDeviceTest, AFaultStopsThePoseAndItGoesOnAfterwards) {
  WireRig rig(driver(), OptionsOf(GetParam().name));
  ASSERT_TRUE(rig.is_open());
  constexpr int kLimit = 600;
  int side = 1;
  for (const Fault fault : {Fault::kUnplugged, Fault::kNotANumber}) {
    SCOPED_TRACE(ToString(fault));
    side = -side;
    rig.hardware().SetHand(Wanting(spatial::Pose(Vec3(0.08 * side, 0, 0))));
    rig.Run(100);
    ASSERT_LE(rig.RunUntilReady(kLimit), kLimit);
    rig.hardware().SetFault(fault);
    const DeviceState first = rig.Run(3);
    EXPECT_FALSE(first.is_valid);
    EXPECT_EQ(first.condition,
              fault == Fault::kUnplugged ? Condition::kLost : Condition::kImplausible);
    const DeviceState last = rig.Run(100);
    EXPECT_FALSE(last.is_valid);
    EXPECT_EQ((last.X_DH.p() - first.X_DH.p()).norm(), 0);
    rig.hardware().SetFault(Fault::kNone);
    EXPECT_LE(rig.RunUntilReady(kLimit), kLimit);
  }
}

TEST_P(RateDeviceTest, FiveHundredRandomSchedulesEndReady) {
  WireRig rig(driver(), OptionsOf(GetParam().name));
  ASSERT_TRUE(rig.is_open());
  constexpr int kLimit = 600;
  DeviceState before = rig.Run(1);
  for (std::uint64_t seed = 1; seed <= 500 && !HasFatalFailure(); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const Vec3 p(random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1), random.Uniform(-0.1, 0.1));
    rig.hardware().SetHand(Wanting(spatial::Pose(p)));
    for (int i = 0; i < 4; ++i) {
      const auto which = static_cast<std::size_t>(random.Uniform(0, kFaults.size()));
      rig.hardware().SetFault(i % 2 == 0 ? kFaults[which] : Fault::kNone);
      for (int k = static_cast<int>(random.Uniform(1, 60)); k > 0; --k) {
        const DeviceState state = rig.Run(1);
        ASSERT_TRUE(spatial::IsFinite(state.X_DH));
        ASSERT_LE(state.X_DH.p().cwiseAbs().maxCoeff(), 0.1 + 1e-12);
        ASSERT_LE((state.X_DH.p() - before.X_DH.p()).norm(), 1e-3);  // no leaps, whatever happens
        before = state;
      }
    }
    ASSERT_LE(rig.RunUntilReady(kLimit), kLimit);
    before = rig.Run(1);
  }
}

INSTANTIATE_TEST_SUITE_P(Wire, RateDeviceTest,
                         ::testing::Values(Case{SpaceMouseDriver, "spacemouse"},
                                           Case{GamepadDriver, "gamepad"}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(SpaceMouseTest, ACapThatIsPushedInSilenceIsTakenToBeLetGoOf) {
  WireRig rig(SpaceMouseDriver(), OptionsOf("spacemouse"));
  ASSERT_TRUE(rig.is_open());
  rig.hardware().SetHand(Wanting(spatial::Pose(Vec3(0.09, 0, 0))));
  EXPECT_EQ(rig.Run(100).condition, Condition::kReady);
  rig.hardware().SetFault(Fault::kStalled);
  EXPECT_EQ(rig.Run(450).condition, Condition::kReady);
  EXPECT_EQ(rig.Run(100).condition, Condition::kStale);
}

TEST(SpaceMouseTest, FramesInPiecesAreReadAsOne) {
  const TemporaryFolder folder;
  const auto listener = ListenAt((folder / "var/run/spnav.sock").string(), SOCK_STREAM);
  ASSERT_TRUE(listener);
  VirtualClock clock;
  Surroundings surroundings;
  surroundings.root = folder.path();
  surroundings.clock = &clock;
  const auto device = SpaceMouseDriver().Open("", surroundings);
  ASSERT_TRUE(device) << device.error().ToString();
  EXPECT_FALSE((*device)->info().is_emulated);
  const Descriptor client = TryAccept(*listener);
  ASSERT_TRUE(client.is_open());
  const spacenav::Frame frame{spacenav::kPress, 1};
  const auto* bytes = reinterpret_cast<const char*>(frame.data());
  for (std::size_t i = 0; i < sizeof(frame); ++i) {
    clock.Advance(kTickNs);
    EXPECT_EQ((*device)->Read().buttons, 0u);
    ASSERT_EQ(::send(client.value(), bytes + i, 1, MSG_NOSIGNAL), 1);
  }
  clock.Advance(kTickNs);
  EXPECT_EQ((*device)->Read().buttons, 2u);
}

TEST(SpaceMouseTest, ProbingTellsAMissingDaemonFromOneThatHasEnded) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  surroundings.root = folder.path();
  ProbeReport report = SpaceMouseDriver().Probe(surroundings, false);
  ASSERT_EQ(report.problems.size(), 1u);
  EXPECT_EQ(report.problems[0].where, (folder / "var/run/spnav.sock").string());
  EXPECT_NE(report.problems[0].message.find("spacenavd is not running"), std::string::npos);
  EXPECT_NE(report.problems[0].remedy.find("apt install spacenavd"), std::string::npos);
  folder.Write("etc/spnavrc", "# settings\nsensitivity = 1\nsocket = \"/run/other.sock\"\n");
  report = SpaceMouseDriver().Probe(surroundings, false);
  EXPECT_EQ(report.problems.at(0).where, (folder / "run/other.sock").string());
  { const auto gone = ListenAt((folder / "run/other.sock").string(), SOCK_STREAM); }
  report = SpaceMouseDriver().Probe(surroundings, false);
  EXPECT_NE(report.problems.at(0).message.find("no process listens"), std::string::npos);
}

TEST(GamepadTest, RumbleIsAsStrongAsTheForceAndEndsByItself) {
  WireRig rig(GamepadDriver(), OptionsOf("gamepad"));
  ASSERT_TRUE(rig.is_open());
  EXPECT_TRUE(rig.device().info().capabilities.can_rumble);
  const auto strength = [&rig] { return rig.truth().command.f.z(); };
  spatial::Wrench F;
  F.f = Vec3(0, -1.5, 2);  // 2.5 N of 5
  rig.Run(20, F);
  EXPECT_NEAR(strength(), 0.5, 0.01);
  rig.Run(500, F);
  EXPECT_NEAR(strength(), 0.5, 0.01);
  F.f *= 10;
  rig.Run(20, F);
  EXPECT_NEAR(strength(), 1, 0.01);
  rig.Run(3);
  EXPECT_EQ(strength(), 0);
  rig.Run(20, F);
  rig.emulator().Advance(250 * kTickNs);  // nobody writes any more
  EXPECT_EQ(strength(), 0);
  rig.Run(20, F);
  EXPECT_GT(strength(), 0.9);
  rig.Close();
  rig.emulator().Advance(3 * kTickNs);
  EXPECT_EQ(strength(), 0);
}

TEST(GamepadTest, WhereNothingIsPluggedInItSaysSo) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  surroundings.root = folder.path();
  const ProbeReport report = GamepadDriver().Probe(surroundings, true);
  ASSERT_EQ(report.problems.size(), 1u);
  EXPECT_EQ(report.problems[0].message, "no gamepad or joystick is connected");
  EXPECT_EQ(report.problems[0].where, (folder / "dev/input").string());
  const auto device = GamepadDriver().Open((folder / "dev/input/event3").string(), surroundings);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "there is no such input device");
}

TEST(GamepadTest, WhatIsNoGamepadIsPassedOver) {
  const TemporaryFolder folder;
  folder.Write("dev/input/event2", "");
  folder.Write("dev/input/mice", "");
  Surroundings surroundings;
  surroundings.root = folder.path();
  const ProbeReport report = GamepadDriver().Probe(surroundings, true);
  ASSERT_EQ(report.looked_for.size(), 1u);
  EXPECT_FALSE(report.looked_for[0].is_found);
  EXPECT_TRUE(report.devices.empty());
  EXPECT_NE(GamepadDriver()
                .Open((folder / "dev/input/event2").string(), surroundings)
                .error()
                .message.find("is not a gamepad"),
            std::string::npos);
}

TEST(GamepadTest, ANodeThatCannotBeOpenedIsToldOnlyIfItsKeysMayBeAGamepads) {
  const TemporaryFolder folder;
  const std::string node = (folder / "dev/input/event4").string();
  { const auto gone = ListenAt(node, SOCK_SEQPACKET); }  // nobody answers there
  Surroundings surroundings;
  surroundings.root = folder.path();
  EXPECT_EQ(GamepadDriver().Probe(surroundings, false).problems.at(0).where, node);
  const std::string keys = "sys/class/input/event4/device/capabilities/key";
  folder.Write(keys, "7cdb000000000000 0 0 0 0\n");  // bits 304 to 318: a gamepad
  EXPECT_EQ(GamepadDriver().Probe(surroundings, false).problems.at(0).where, node);
  folder.Write(keys, "402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe\n");  // keyboard
  EXPECT_EQ(GamepadDriver().Probe(surroundings, false).problems.at(0).message,
            "no gamepad or joystick is connected");
}

/** A gamepad that the kernel itself believes in. */
class UinputGamepad {
 public:
  UinputGamepad() : uinput_(::open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}

  [[nodiscard]] bool is_there() const { return uinput_.is_open(); }

  /** The path of its node; empty where the kernel makes none. */
  std::string Create() {
    const int file = uinput_.value();
    ::ioctl(file, UI_SET_EVBIT, EV_KEY);
    ::ioctl(file, UI_SET_KEYBIT, BTN_SOUTH);
    for (const int code : {ABS_X, ABS_Y}) {
      uinput_abs_setup axis{};
      axis.code = static_cast<std::uint16_t>(code);
      axis.absinfo.minimum = -100;
      axis.absinfo.maximum = 100;
      ::ioctl(file, UI_ABS_SETUP, &axis);
    }
    uinput_setup setup{};
    std::strcpy(setup.name, "EMULATED by a test of HVAS");
    ::ioctl(file, UI_DEV_SETUP, &setup);
    ::ioctl(file, UI_DEV_CREATE);
    char name[64] = "";
    ::ioctl(file, UI_GET_SYSNAME(sizeof(name)), name);
    std::error_code failure;
    const std::filesystem::path folder = std::filesystem::path("/sys/devices/virtual/input") / name;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
      const std::string node = entry.path().filename().string();
      if (node.starts_with("event")) {
        return "/dev/input/" + node;
      }
    }
    return {};
  }

  void PushRight() const {
    input_event events[2]{};
    events[0].type = EV_ABS;
    events[0].code = ABS_X;
    events[0].value = 100;
    (void)!::write(uinput_.value(), events, sizeof(events));
  }

 private:
  Descriptor uinput_;
};

TEST(GamepadTest, AGamepadOfTheKernelMovesThePose) {
  UinputGamepad gamepad;
  if (!gamepad.is_there()) {
    GTEST_SKIP() << "/dev/uinput cannot be opened, so that the kernel makes no gamepad; the other "
                    "tests of the driver have a socket in place of the kernel's node";
  }
  const std::string path = gamepad.Create();
  if (::access(path.c_str(), R_OK) != 0) {
    GTEST_SKIP() << "the kernel has made a gamepad, but its node '" << path
                 << "' cannot be read, as in a container with a /dev of its own";
  }
  VirtualClock clock;
  Surroundings surroundings;
  surroundings.clock = &clock;
  const auto device = GamepadDriver().Open(path, surroundings);
  ASSERT_TRUE(device) << device.error().ToString();
  gamepad.PushRight();
  DeviceState state;
  for (int i = 0; i < 20; ++i) {
    clock.Advance(kTickNs);
    state = (*device)->Read();
  }
  EXPECT_GT(state.X_DH.p().x(), 0);
}

TEST(GamepadTest, WithoutPermissionTheGroupAndTheRuleAreNamed) {
  const Error error = EvdevProblem(EACCES, "/dev/input/event5");
  EXPECT_EQ(error.where, "/dev/input/event5");
  EXPECT_NE(error.remedy.find("usermod -aG input"), std::string::npos);
  EXPECT_NE(error.remedy.find("ID_INPUT_JOYSTICK"), std::string::npos);
}

}  // namespace
}  // namespace hvas::device
