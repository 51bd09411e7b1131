#include "device/emulation/emulator.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "device/emulation/library_emulator.h"
#include "device/emulation/wire_emulator.h"

namespace hvas::device {
namespace {

constexpr std::array kByLibrary{"openhaptics", "forcedimension", "virtuose"};
constexpr std::array kByWire{"haply", "spacemouse", "gamepad", "network", "plugin"};

template <typename Names>
bool Has(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Result<std::unique_ptr<Emulator>> StartEmulator(std::string_view driver,
                                                const EmulatorOptions& options) {
  if (Has(kByLibrary, driver)) {
    return StartLibraryEmulator(driver, options);
  }
  if (Has(kByWire, driver)) {
    return StartWireEmulator(driver, options);
  }
  return Fail(ErrorCode::kNotFound, fmt::format("there is no emulator for \"{}\"", driver), {},
              fmt::format("one of: {}", fmt::join(EmulatedDrivers(), ", ")));
}

std::vector<std::string> EmulatedDrivers() {
  std::vector<std::string> names(kByLibrary.begin(), kByLibrary.end());
  names.insert(names.end(), kByWire.begin(), kByWire.end());
  return names;
}

}  // namespace hvas::device
