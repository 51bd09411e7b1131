#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "device/emulation/emulator.h"

namespace hvas::device {

/** How the vendor's software behind an emulated device behaves at the start. */
struct LibraryManners {
  bool is_licensed{true};         ///< OpenHaptics.
  bool is_calibrated{true};       ///< OpenHaptics, Force Dimension.
  bool can_calibrate{true};       ///< It calibrates itself when asked to.
  bool is_of_this_version{true};  ///< Virtuose: library and controller fit.
};

/** Starts an emulator of a device that is reached through a vendor's library: a stub library with
 the vendor's file name and functions, around an EmulatedDevice. For "openhaptics",
 "forcedimension" and "virtuose". Errors: kNotFound for another driver, or without the stub; and
 kOutOfResource when too many run at once. */
Result<std::unique_ptr<Emulator>> StartLibraryEmulator(std::string_view driver,
                                                       const EmulatorOptions& options,
                                                       const LibraryManners& manners = {});

/** Where the stub libraries are. */
[[nodiscard]] std::filesystem::path StubFolder();

}  // namespace hvas::device
