#pragma once

#include <chrono>
#include <memory>
#include <thread>

#include "device/test/library_rig.h"

namespace hvas::device::testing {

/** Ticks of 1 ms after which a condition that has not come is taken not to come: a choice, a
 * minute. */
inline constexpr int kMostTicks = 60'000;

/** Starts the emulator of a driver with its threads in real time; nobody pushes its handle. */
inline std::unique_ptr<Emulator> StartLive(const LibraryCase& which, const DeviceProfile& profile) {
  EmulatorOptions options;
  options.profile = profile;
  options.is_live = true;
  auto emulator = StartCase(which, options);
  emulator->device().SetHand({});
  return emulator;
}

inline std::unique_ptr<Emulator> StartLive(const LibraryCase& which) {
  return StartLive(which, ProfileNamed(which.profile));
}

/** Ticks until a device is in a condition; false when it never is. */
inline bool TickUntil(Device& device, Condition condition) {
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

}  // namespace hvas::device::testing
