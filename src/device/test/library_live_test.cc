// The drivers and the vendors' threads at once, in real time (N6, N8). No claim is about how long.

#include <chrono>
#include <thread>

#include "base/clock.h"
#include "base/test/await_true.h"
#include "device/test/live_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

class LibraryLiveTest : public ::testing::TestWithParam<const LibraryCase*> {};

INSTANTIATE_TEST_SUITE_P(Drivers, LibraryLiveTest,
                         ::testing::Values(&kOpenHaptics, &kForceDimension, &kVirtuose),
                         [](const auto& entry) { return entry.param->name; });

TEST_P(LibraryLiveTest, ADeviceThatIsUnpluggedIsTakenUpAgainOffTheHapticThread) {
  const auto emulator = StartLive(*GetParam());
  auto device = OpenEmulated(*GetParam(), *emulator);
  ASSERT_TRUE(device.has_value());
  EXPECT_TRUE(TickUntil(**device, Condition::kReady));
  emulator->device().SetFault(Fault::kUnplugged);
  EXPECT_TRUE(TickUntil(**device, Condition::kLost));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // Attempts that fail.
  emulator->device().SetFault(Fault::kNone);
  EXPECT_TRUE(TickUntil(**device, Condition::kReady));
  device->reset();
  const auto force = [&] { return emulator->device().truth().command.f.norm(); };
  EXPECT_TRUE(hvas::testing::AwaitTrue([&] { return force() == 0; }));
}

TEST(EmulatorLiveTest, HandleIsWhereItIsByNowHoweverLateTheEmulatorsThreadIs) {
  DeviceProfile profile = ProfileNamed("sigma7");
  profile.rate_hz = 8000;
  const auto emulator = StartLive(kForceDimension, profile);
  auto device = OpenEmulated(kForceDimension, *emulator);
  ASSERT_TRUE(device.has_value());
  std::int64_t before_ns = 0;
  for (int k = 0; k < 200; ++k) {  // Twice as often as the emulator's thread moves the handle.
    const std::int64_t end_ns = MonotonicNs() + 500'000;
    while (MonotonicNs() < end_ns) {
    }
    const DeviceState state = (*device)->Read();
    EXPECT_EQ(state.sample_ns, state.t_ns);
    EXPECT_GT(state.sample_ns, before_ns);
    before_ns = state.sample_ns;
  }
}

TEST_P(LibraryLiveTest, ADeviceCanBeClosedWhileItIsGone) {
  const auto emulator = StartLive(*GetParam());
  auto device = OpenEmulated(*GetParam(), *emulator);
  ASSERT_TRUE(device.has_value());
  emulator->device().SetFault(Fault::kUnplugged);
  EXPECT_TRUE(TickUntil(**device, Condition::kLost));
  device->reset();
  emulator->device().SetFault(Fault::kNone);
  EXPECT_TRUE(OpenEmulated(*GetParam(), *emulator).has_value());
}

TEST_P(LibraryLiveTest, TwoDevicesOfADriverWorkAtOnce) {
  const auto left = StartLive(*GetParam());
  const auto right = StartLive(*GetParam());
  auto left_device = OpenEmulated(*GetParam(), *left);
  ASSERT_TRUE(left_device.has_value());
  std::thread other([&] {
    auto right_device = OpenEmulated(*GetParam(), *right);
    ASSERT_TRUE(right_device.has_value());
    EXPECT_TRUE(TickUntil(**right_device, Condition::kReady));
  });
  EXPECT_TRUE(TickUntil(**left_device, Condition::kReady));
  other.join();
  EXPECT_TRUE(TickUntil(**left_device, Condition::kReady));
}

}  // namespace
}  // namespace hvas::device
