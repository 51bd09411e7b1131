// Plug-ins: the example in C, the versions of the interface, and samples that are garbage (N8).
#include <cmath>
#include <limits>

#include <dlfcn.h>

#include "base/test/temporary_folder.h"
#include "device/emulation/emulated_plugin.h"
#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using hvas::testing::TemporaryFolder;
using testing::kTickNs;
using testing::OptionsOf;
using testing::Push;
using testing::WireRig;

std::string ErrorOf(const std::string& address) {
  const auto device = PluginDriver().Open(address, {});
  EXPECT_FALSE(device) << address;
  return device ? "" : device.error().ToString();
}

void ExpectError(const std::string& address, const std::string& part) {
  const std::string error = ErrorOf(address);
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

TEST(ExamplePluginTest, AConstantForceReachesTheSpeedThatFrictionAllows) {  // v = F / b
  VirtualClock clock;
  Surroundings surroundings;
  surroundings.clock = &clock;
  const auto device = PluginDriver().Open(HVAS_EXAMPLE_PLUGIN "?0.05", surroundings);
  ASSERT_TRUE(device) << device.error().ToString();
  EXPECT_EQ((*device)->info().model, "Simulated handle");
  EXPECT_EQ((*device)->info().address, "plugin:" HVAS_EXAMPLE_PLUGIN "?0.05");
  EXPECT_TRUE((*device)->info().is_emulated);
  EXPECT_EQ((*device)->info().profile.max_force, 5);
  EXPECT_EQ((*device)->info().capabilities.torque_axes, 0);
  DeviceState state;
  for (int i = 0; i < 300; ++i) {
    clock.Advance(kTickNs);
    state = (*device)->Read();
    ASSERT_EQ(state.condition, Condition::kReady);
    (*device)->Write(Push(0.4));
  }
  EXPECT_NEAR(state.V_DH.v.x(), 0.4 / 2.0, 1e-3);
  for (int i = 0; i < 600; ++i) {  // nobody writes any more: it comes to rest
    clock.Advance(kTickNs);
    state = (*device)->Read();
  }
  EXPECT_LT(state.V_DH.v.norm(), 1e-6);
}

TEST(ExamplePluginTest, SaysItselfWhatIsWrongWithItsArgument) {
  ExpectError(HVAS_EXAMPLE_PLUGIN "?heavy", "the mass \"heavy\" is none");
}

TEST(PluginDriverTest, WhatIsNoPluginIsExplained) {
  ExpectError("/nowhere/arm.so", "there is no such plug-in");
  const TemporaryFolder folder;
  ExpectError(folder.Write("text.so", "not a library"), "the plug-in cannot be loaded");
  ExpectError("", "no plug-in is given, and none is installed");
  ExpectError(HVAS_ODD_PLUGIN_NONE, "it has no function hvas_device_plugin");
}

TEST(PluginDriverTest, AnotherVersionOfTheInterfaceIsToldClearly) {
  ExpectError(HVAS_ODD_PLUGIN_VERSION,
              "the plug-in was built for version 7 of the interface, HVAS has version 1");
  ExpectError(HVAS_ODD_PLUGIN_HOLE, "function table is incomplete");
}

TEST(PluginDriverTest, ProbingOpensWhatIsInstalled) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  surroundings.root = folder.path();
  ProbeReport report = PluginDriver().Probe(surroundings, true);
  ASSERT_EQ(report.problems.size(), 1u);
  EXPECT_EQ(report.problems[0].message, "no plug-in is installed");
  const std::filesystem::path plugins = folder.path() / "usr/lib/hvas/plugins";
  std::filesystem::create_directories(plugins);
  std::filesystem::create_symlink(HVAS_EXAMPLE_PLUGIN, plugins / "handle.so");
  std::filesystem::create_symlink(HVAS_ODD_PLUGIN_VERSION, plugins / "old.so");
  report = PluginDriver().Probe(surroundings, true);
  ASSERT_EQ(report.looked_for.size(), 2u);
  ASSERT_EQ(report.devices.size(), 1u);
  EXPECT_EQ(report.devices[0].model, "Simulated handle");
  EXPECT_EQ(report.problems.size(), 1u);
  EXPECT_TRUE(PluginDriver().Open("", surroundings));
}

/** A plug-in whose sample is whatever the test wants. */
class OddPlugin {
 public:
  OddPlugin() : library_(::dlopen(HVAS_EMULATED_PLUGIN, RTLD_NOW)) {
    register_ = reinterpret_cast<decltype(register_)>(::dlsym(library_, "hvas_emulator_register"));
    sample.orientation[0] = 1;
    const HvasEmulatedPlugin plugin{this, Describe, Read, Write};
    register_("odd", &plugin);
    surroundings_.clock = &clock_;
  }

  OddPlugin(const OddPlugin&) = delete;
  OddPlugin& operator=(const OddPlugin&) = delete;

  ~OddPlugin() {
    register_("odd", nullptr);
    ::dlclose(library_);
  }

  Result<std::unique_ptr<Device>> Open() {
    return PluginDriver().Open(HVAS_EMULATED_PLUGIN "?odd", surroundings_);
  }

  DeviceState Tick(Device* device) {
    clock_.Advance(kTickNs);
    const DeviceState state = device->Read();
    device->Write(Push(1));
    return state;
  }

  HvasDeviceSample sample{};
  HvasDeviceWrench wrench{};
  double max_force{3};

 private:
  static void Describe(void* context, HvasDeviceDescription* description) {
    description->max_force = static_cast<OddPlugin*>(context)->max_force;
  }

  static std::int32_t Read(void* context, std::uint64_t*, HvasDeviceSample* sample) {
    *sample = static_cast<OddPlugin*>(context)->sample;
    return HVAS_DEVICE_READY;
  }

  static void Write(void* context, const HvasDeviceWrench* wrench) {
    static_cast<OddPlugin*>(context)->wrench = *wrench;
  }

  void* library_;
  void (*register_)(const char* name, const HvasEmulatedPlugin* plugin);
  VirtualClock clock_;
  Surroundings surroundings_;
};

TEST(PluginDeviceTest, GarbageIsNotBelievedAndGetsNoForce) {
  OddPlugin plugin;
  const auto device = plugin.Open();
  ASSERT_TRUE(device) << device.error().ToString();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<void (*)(HvasDeviceSample*)> spoils{
      [](HvasDeviceSample* s) { s->position[1] = kNan; },
      [](HvasDeviceSample* s) { s->position[2] = 1e30; },
      [](HvasDeviceSample* s) { s->velocity[0] = std::numeric_limits<double>::infinity(); },
      [](HvasDeviceSample* s) { s->orientation[0] = 0; },
      [](HvasDeviceSample* s) { s->orientation[2] = 3; },
  };
  for (std::size_t i = 0; i < spoils.size(); ++i) {
    const HvasDeviceSample good = plugin.sample;
    for (int k = 0; k < 120; ++k) {
      (void)plugin.Tick(device->get());
    }
    EXPECT_EQ(plugin.wrench.force[0], 1) << i;
    spoils[i](&plugin.sample);
    const DeviceState state = plugin.Tick(device->get());
    EXPECT_FALSE(state.is_valid) << i;
    EXPECT_EQ(state.condition, Condition::kImplausible) << i;
    EXPECT_EQ(plugin.wrench.force[0], 0) << i;
    plugin.sample = good;
  }
}

TEST(PluginDeviceTest, WhatItTellsAboutItselfHasToBePossible) {
  OddPlugin plugin;
  plugin.max_force = -1;
  const auto device = plugin.Open();
  ASSERT_FALSE(device);
  EXPECT_NE(device.error().message.find("impossible"), std::string::npos);
}

TEST(PluginDeviceTest, TwoDevicesOfOnePluginAreApart) {
  WireRig left(PluginDriver(), OptionsOf("touch"));
  WireRig right(PluginDriver(), OptionsOf("touch_x"));
  ASSERT_TRUE(left.is_open() && right.is_open());
  left.hardware().SetHand({});
  right.hardware().SetHand({});
  left.Run(20, Push(1));
  right.Run(20, Push(-0.5));
  EXPECT_NEAR(left.truth().F_H_D.f.x(), 1, 1e-9);
  EXPECT_NEAR(right.truth().F_H_D.f.x(), -0.5, 1e-9);
}

}  // namespace
}  // namespace hvas::device
