// The drivers and the vendors' threads at once, in real time (N6, N8). No claim is about how long.

#include <chrono>
#include <thread>

#include "device/test/library_rig.h"

namespace hvas::device {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)

class LibraryLiveTest : public ::testing::TestWithParam<const LibraryCase*> {};

INSTANTIATE_TEST_SUITE_P(Drivers, LibraryLiveTest,
                         ::testing::Values(&kOpenHaptics, &kForceDimension, &kVirtuose),
                         [](const auto& entry) { return entry.param->name; });

constexpr int kMostTicks = 60'000;

std::unique_ptr<Emulator> StartLive(const LibraryCase& which) {
  EmulatorOptions options;
  options.profile = ProfileNamed(which.profile);
  options.is_live = true;
  auto emulator = StartCase(which, options);
  emulator->device().SetHand({});
  return emulator;
}

/** Ticks until a device is in a condition; false when it never is. */
bool TickUntil(Device& device, Condition condition) {
  for (int tick = 0; tick < kMostTicks; ++tick) {
    const DeviceState state = device.Read();
    device.Write({Vec3::Zero(), Vec3(0.5, 0, 0)});
    if (state.condition == condition) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

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
  for (int k = 0; k < kMostTicks && force() > 0; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(force(), 0);
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
