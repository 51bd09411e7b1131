#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "base/result.h"
#include "device/driver.h"
#include "device/emulation/emulated_device.h"

namespace hvas::device {

struct EmulatorOptions {
  DeviceProfile profile;
  /** What the device says of itself, whether it is true or not; without: the profile. */
  std::optional<DeviceProfile> claim;
  spatial::Pose X_DH;   ///< First pose of the handle.
  bool is_live{false};  ///< Runs by the machine's clock, on a thread of its own; else by Advance.
};

/** The lag behind the machine's clock beyond which a live emulator has been asleep, as its process
 may be; it then goes on from where it was: a choice. */
inline constexpr std::int64_t kMaxLiveLagNs = 20'000'000;

/** An emulator of the devices of one driver: the vendor's interface (a stub library with the same
 symbols, or a server with the same protocol) around an EmulatedDevice. The real driver opens it
 through surroundings() and address(), as it would a real device. */
class Emulator {
 public:
  Emulator() = default;
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;
  virtual ~Emulator() = default;

  [[nodiscard]] virtual EmulatedDevice& device() = 0;
  /** What the driver is to be given; lives as long as the emulator. */
  [[nodiscard]] virtual const Surroundings& surroundings() const = 0;
  /** "DRIVER:ADDRESS" of it. */
  [[nodiscard]] virtual std::string address() const = 0;

  /** When not live: moves the physics and the clock in surroundings() on, and runs what the
   vendor's software would run by itself (a scheduler's callbacks, packets on the wire). */
  virtual void Advance(std::int64_t step_ns) = 0;
};

/** Starts an emulator of a driver's devices.
 Errors: kNotFound for a driver without one (the message lists those with), and what goes wrong. */
Result<std::unique_ptr<Emulator>> StartEmulator(std::string_view driver,
                                                const EmulatorOptions& options);

/** The drivers that have one. */
[[nodiscard]] std::vector<std::string> EmulatedDrivers();

}  // namespace hvas::device
