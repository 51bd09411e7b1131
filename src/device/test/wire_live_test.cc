// The same drivers by the machine's clock, with their threads; how fast anything is, is not
// asserted.
#include <chrono>
#include <thread>

#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using testing::OptionsOf;
using testing::Push;

constexpr int kLimit = 120'000;  // of ticks of 0.5 ms: a minute, a choice

struct Case {
  const Driver& (*driver)();
  const char* name;
  const char* profile;
};

class LiveTest : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    EmulatorOptions options = OptionsOf(GetParam().profile);
    options.is_live = true;
    auto emulator = StartWireEmulator(GetParam().name, options);
    ASSERT_TRUE(emulator) << emulator.error().ToString();
    emulator_ = std::move(*emulator);
    emulator_->device().SetHand({});
    Open();
  }

  void Open() {
    const std::string address = emulator_->address();
    auto device =
        GetParam().driver().Open(address.substr(address.find(':') + 1), emulator_->surroundings());
    ASSERT_TRUE(device) << device.error().ToString();
    device_ = std::move(*device);
  }

  /** Ticks until something holds. */
  template <typename Predicate>
  bool RunUntil(Predicate holds) {
    for (int i = 0; i < kLimit; ++i) {
      const DeviceState state = device_->Read();
      device_->Write(Push(1));
      if (holds(state)) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    return false;
  }

  [[nodiscard]] double Commanded() const { return emulator_->device().truth().command.f.norm(); }

  std::unique_ptr<Emulator> emulator_;
  std::unique_ptr<Device> device_;
};

TEST_P(LiveTest, ForceArrivesAFaultTakesItAwayAndItComesBack) {
  const bool shows_force = device_->info().capabilities.force_axes > 0;
  const auto is_ready = [&](const DeviceState& state) {
    return state.condition == Condition::kReady && (!shows_force || Commanded() == 1);
  };
  EXPECT_TRUE(RunUntil(is_ready));
  emulator_->device().SetFault(Fault::kUnplugged);
  EXPECT_TRUE(RunUntil([](const DeviceState& state) { return !state.is_valid; }));
  emulator_->device().SetFault(Fault::kNone);
  EXPECT_TRUE(RunUntil(is_ready));
}

TEST_P(LiveTest, ItIsClosedAndOpenedAgainAtAnyMoment) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(RunUntil([i](const DeviceState& state) { return i % 2 == 0 || state.is_valid; }));
    device_.reset();
    ASSERT_NO_FATAL_FAILURE(Open());
  }
  device_.reset();
  for (int i = 0; i < kLimit && Commanded() > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  EXPECT_EQ(Commanded(), 0);
}

INSTANTIATE_TEST_SUITE_P(Wire, LiveTest,
                         ::testing::Values(Case{HaplyDriver, "haply", "inverse3"},
                                           Case{NetworkDriver, "network", "network"},
                                           Case{PluginDriver, "plugin", "touch"},
                                           Case{SpaceMouseDriver, "spacemouse", "spacemouse"},
                                           Case{GamepadDriver, "gamepad", "gamepad"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace hvas::device
