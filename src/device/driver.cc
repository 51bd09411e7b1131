#include "device/driver.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "device/drivers/vendor_drivers.h"
#include "device/drivers/wire_drivers.h"
#include "device/force_withdrawal.h"

namespace hvas::device {

const std::vector<const Driver*>& Drivers() {
  static const std::vector<const Driver*> drivers{
      &OpenHapticsDriver(), &ForceDimensionDriver(), &VirtuoseDriver(), &HaplyDriver(),
      &SpaceMouseDriver(),  &GamepadDriver(),        &NetworkDriver(),  &PluginDriver()};
  return drivers;
}

Result<std::unique_ptr<Device>> OpenDevice(const std::string& address,
                                           const Surroundings& surroundings) {
  const std::size_t colon = address.find(':');
  const std::string name = address.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : address.substr(colon + 1);
  for (const Driver* driver : Drivers()) {
    if (driver->name() == name) {
      auto device = driver->Open(rest, surroundings);
      if (device && !NoteOpenDevice(device->get())) {
        return Fail(ErrorCode::kOutOfResource,
                    "so many devices are open that the force of another one could not be withdrawn "
                    "if the program crashed",
                    address, "close another device first");
      }
      return device;
    }
  }
  std::vector<std::string_view> names;
  for (const Driver* driver : Drivers()) {
    names.push_back(driver->name());
  }
  return Fail(ErrorCode::kInvalid, fmt::format("there is no driver \"{}\"", name), address,
              fmt::format("one of: {}", fmt::join(names, ", ")));
}

}  // namespace hvas::device
