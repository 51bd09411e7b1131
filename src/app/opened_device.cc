#include "app/opened_device.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "device/driver.h"

namespace hvas::app {
namespace {

constexpr std::string_view kEmulated = "emulated:";

const device::SourcedProfile* FindProfileFor(const std::string& driver, const std::string& id) {
  for (const device::SourcedProfile& profile : device::KnownProfiles()) {
    if (id.empty() ? profile.driver == driver : profile.profile.id == id) {
      return &profile;
    }
  }
  return nullptr;
}

std::string ListProfiles(const std::string& driver) {
  std::string list;
  for (const device::SourcedProfile& profile : device::KnownProfiles()) {
    if (profile.driver == driver) {
      list += (list.empty() ? "" : ", ") + profile.profile.id;
    }
  }
  return list;
}

Result<OpenedDevice> OpenEmulated(const std::string& text, bool is_live) {
  const std::size_t colon = text.find(':');
  const std::string driver = text.substr(0, colon);
  const std::string id = colon == std::string::npos ? "" : text.substr(colon + 1);
  device::EmulatorOptions options;
  options.is_live = is_live;
  if (const device::SourcedProfile* profile = FindProfileFor(driver, id); profile != nullptr) {
    options.profile = profile->profile;
  } else if (!id.empty()) {
    return Fail(ErrorCode::kInvalid, fmt::format("there is no device profile \"{}\"", id), text,
                fmt::format("of {}: {}", driver, ListProfiles(driver)));
  }
  OpenedDevice opened;
  auto emulator = device::StartEmulator(driver, options);
  if (!emulator) {
    return Unexpected(emulator.error());
  }
  opened.emulator = std::move(*emulator);
  auto device = device::OpenDevice(opened.emulator->address(), opened.emulator->surroundings());
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
  auto device = device::OpenDevice(address, device::Surroundings());
  if (!device) {
    return Unexpected(device.error());
  }
  OpenedDevice opened;
  opened.device = std::move(*device);
  return opened;
}

}  // namespace hvas::app
