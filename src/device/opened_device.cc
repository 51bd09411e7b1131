#include "device/opened_device.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "device/driver.h"

namespace hvas::device {
namespace {

constexpr std::string_view kEmulated = "emulated:";

std::string ListProfiles(const std::string& driver) {
  std::string list;
  for (const SourcedProfile& profile : KnownProfiles()) {
    if (profile.driver == driver) {
      list += (list.empty() ? "" : ", ") + profile.profile.id;
    }
  }
  return list;
}

bool IsDriver(std::string_view name) {
  const auto& drivers = Drivers();
  return std::any_of(drivers.begin(), drivers.end(),
                     [&](const Driver* driver) { return driver->name() == name; });
}

Result<OpenedDevice> OpenEmulated(const std::string& text, bool is_live) {
  const std::size_t colon = text.find(':');
  const std::string driver = text.substr(0, colon);
  const std::string id = colon == std::string::npos ? "" : text.substr(colon + 1);
  EmulatorOptions options;
  options.is_live = is_live;
  if (const auto* profile = FindProfileOfDriver(driver, id); profile != nullptr) {
    options.profile = profile->profile;
  } else if (const std::string known = ListProfiles(driver); !id.empty() && !known.empty()) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} has no device profile \"{}\"", driver, id),
                text, fmt::format("one of: {}", known));
  } else {
    options.profile.name = "device of a " + driver;
  }
  OpenedDevice opened;
  auto emulator = StartEmulator(driver, options);
  if (!emulator) {
    return Unexpected(emulator.error());
  }
  opened.emulator = std::move(*emulator);
  auto device = OpenDevice(opened.emulator->address(), opened.emulator->surroundings());
  if (!device) {
    return Unexpected(device.error());
  }
  opened.device = std::move(*device);
  return opened;
}

}  // namespace

Result<OpenedDevice> OpenAnyDevice(const std::string& address, bool is_live) {
  if (address.rfind(kEmulated, 0) == 0) {
    return OpenEmulated(address.substr(kEmulated.size()), is_live);
  }
  if (!is_live && IsDriver(std::string_view(address).substr(0, address.find(':')))) {
    return Fail(ErrorCode::kInvalid, "a real device needs the real-time loop", address,
                "add --realtime, or leave out --clock");
  }
  auto device = OpenDevice(address, Surroundings());
  if (!device) {
    return Unexpected(device.error());
  }
  OpenedDevice opened;
  opened.device = std::move(*device);
  return opened;
}

}  // namespace hvas::device
