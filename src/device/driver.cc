#include "device/driver.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/utf8.h"
#include "device/drivers/vendor_drivers.h"
#include "device/drivers/wire_drivers.h"
#include "device/force_withdrawal.h"

namespace hvas::device {
namespace {

constexpr int kMostButtons = 32;        // Bits of DeviceState::buttons.
constexpr std::size_t kMostText = 256;  // [bytes] of a name; USB has 126 characters. A choice.
constexpr std::size_t kShownText = 40;  // [bytes] of it in a message: a choice.

/** The number of bytes of the character that begins a text, where it is UTF-8 and no control
 character; else 0. */
std::size_t MeasureCharacter(std::string_view text) {
  const std::size_t size = MeasureUtf8(text);
  const auto first = static_cast<unsigned char>(text[0]);
  const bool is_c0 = first < 0x20 || first == 0x7F;
  const bool is_c1 = size == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0;
  return is_c0 || is_c1 ? 0 : size;
}

/** A text as it may be printed: what is no character is a question mark. */
std::string MakePrintable(std::string_view text) {
  std::string printable;
  while (!text.empty() && printable.size() < kShownText) {
    const std::size_t size = MeasureCharacter(text);
    printable += size > 0 ? text.substr(0, size) : "?";
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return printable;
}

bool IsText(std::string_view text) {
  if (text.size() > kMostText) {
    return false;
  }
  while (!text.empty()) {
    const std::size_t size = MeasureCharacter(text);
    if (size == 0) {
      return false;
    }
    text.remove_prefix(size);
  }
  return true;
}

/** The device for messages: by the name of its driver, and what it calls itself. */
std::string NameDevice(const DeviceInfo& info) {
  const std::string model = MakePrintable(info.model);
  return model.empty() ? info.driver : fmt::format("{}, \"{}\"", info.driver, model);
}

Result<void> CheckCapabilities(const Capabilities& can, const std::string& where) {
  const auto fail = [&where](const char* key, int value, const char* possible) {
    return Fail(
        ErrorCode::kInvalid,
        fmt::format("\"{}\" is {}, which is impossible: it must be {}", key, value, possible),
        where, "correct the device's program, or update its driver");
  };
  if (can.force_axes != 0 && can.force_axes != 3) {
    return fail("force_axes", can.force_axes, "0 or 3");
  }
  if (can.torque_axes != 0 && can.torque_axes != 3) {
    return fail("torque_axes", can.torque_axes, "0 or 3");
  }
  if (can.button_count < 0 || can.button_count > kMostButtons) {
    return fail("button_count", can.button_count, "0 to 32");
  }
  return {};
}

}  // namespace

Result<void> CheckInfo(const DeviceInfo& info) {
  const std::string where = NameDevice(info);
  for (const auto& [key, text] : {std::pair<const char*, const std::string&>{"model", info.model},
                                  {"serial", info.serial},
                                  {"version", info.version},
                                  {"name", info.profile.name}}) {
    if (!IsText(text)) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("\"{}\" is \"{}\" with {} bytes, which is impossible: it must be "
                              "UTF-8 text without control characters of at most {} bytes",
                              key, MakePrintable(text), text.size(), kMostText),
                  where, "correct the device's program, or update its driver");
    }
  }
  if (const auto checked = CheckCapabilities(info.capabilities, where); !checked) {
    return Unexpected(checked.error());
  }
  return CheckProfile(info.profile, where);
}

ProbeReport Driver::Probe(const Surroundings& surroundings, bool opens_devices) const {
  ProbeReport report = ProbeUnchecked(surroundings, opens_devices);
  std::vector<DeviceInfo> found;
  for (DeviceInfo& info : report.devices) {
    if (const auto checked = CheckInfo(info)) {
      found.push_back(std::move(info));
    } else {
      report.problems.push_back(checked.error());
    }
  }
  report.devices = std::move(found);
  return report;
}

Result<std::unique_ptr<Device>> Driver::Open(const std::string& address,
                                             const Surroundings& surroundings) const {
  auto device = OpenUnchecked(address, surroundings);
  if (device) {
    if (const auto checked = CheckInfo((*device)->info()); !checked) {
      return Unexpected(checked.error());
    }
  }
  return device;
}

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
