// The drivers and the vendors' threads at once, in real time (N6, N8). No claim is about how long.

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>

#include "base/test/await_true.h"
#include "device/force_withdrawal.h"
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
  EXPECT_TRUE(hvas::testing::AwaitTrue([&] { return force() == 0; }));
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

/** How the process that has a device in somebody's hand can come to its end. */
enum class End { kTerminate, kTick, kAbort, kSegmentationFault, kInterrupt, kTermination };

void Come(End end) {
  switch (end) {
    case End::kTerminate:
      std::thread([] { throw std::runtime_error("of a thread that catches nothing"); }).join();
      break;
    case End::kTick:
      std::terminate();  // as where a tick that is noexcept throws
    case End::kAbort:
      std::abort();
    case End::kSegmentationFault:
      static_cast<void>(std::raise(SIGSEGV));
      break;
    case End::kInterrupt:
      static_cast<void>(std::raise(SIGINT));
      break;
    case End::kTermination:
      static_cast<void>(std::raise(SIGTERM));
      break;
  }
}

/** Runs a process with force on the hand to its end, and returns the force that its device was
 given last [N]; NaN when there was none before. The haptic thread goes on or stands still. */
double ForceAfter(const LibraryCase& which, End end, bool has_loop) {
  struct Shared {
    std::atomic<double> before{0};
    std::atomic<double> last{0};
  };

  void* memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* shared = new (memory) Shared;
  const pid_t child = ::fork();
  if (child == 0) {
    WithdrawForcesAtTheEnd();
    const auto emulator = StartLive(which);
    auto device = OpenDevice(emulator->address(), emulator->surroundings());
    if (!device || !TickUntil(**device, Condition::kReady)) {
      ::_exit(1);
    }
    const auto force = [&] { return emulator->device().truth().command.f.norm(); };
    const auto tick = [&] {
      static_cast<void>((*device)->Read());
      (*device)->Write({Vec3::Zero(), Vec3(0.5, 0, 0)});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    for (int k = 0; k < kMostTicks && force() < 0.4; ++k) {
      tick();
    }
    shared->before = force();
    std::thread([&] {  // whoever looks at the motors from outside
      for (;;) {
        shared->last = force();
      }
    })
        .detach();
    if (has_loop) {
      std::thread([&] {
        for (;;) {
          tick();
        }
      }).detach();
    }
    Come(end);
    ::_exit(2);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "it ends as it would have";
  const double last = shared->before > 0.4 ? shared->last.load() : std::nan("");
  ::munmap(memory, sizeof(Shared));
  return last;
}

TEST_P(LibraryLiveTest, NoEndOfTheProcessLeavesAForceOnTheHand) {
  for (const End end : {End::kTerminate, End::kTick, End::kAbort, End::kSegmentationFault,
                        End::kInterrupt, End::kTermination}) {
    for (const bool has_loop : {true, false}) {
      EXPECT_EQ(ForceAfter(*GetParam(), end, has_loop), 0)
          << static_cast<int>(end) << (has_loop ? ", with" : ", without") << " a haptic loop";
    }
  }
}

}  // namespace
}  // namespace hvas::device
