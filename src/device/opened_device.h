#pragma once

#include <memory>
#include <string>

#include "base/result.h"
#include "device/device.h"
#include "device/emulation/emulator.h"

namespace hvas::device {

/** A device, real or emulated, by the address that a person gave. */
struct OpenedDevice {
  std::unique_ptr<Emulator> emulator;  ///< Null for a real one. Outlives the device.
  std::unique_ptr<Device> device;
};

/** Opens "DRIVER[:ADDRESS]", or "emulated:DRIVER[:PROFILE]" with a device of that profile that is
 not there.
 @param is_live  It is used by the clock; else an emulator is moved on by whoever uses it, and a
 real device is refused.
 Errors: kInvalid for a driver or profile that does not exist (the message lists them); the
 driver's. */
[[nodiscard]] Result<OpenedDevice> OpenAnyDevice(const std::string& address, bool is_live);

}  // namespace hvas::device
