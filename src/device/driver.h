#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "base/result.h"
#include "device/device.h"

namespace hvas::device {

/** Where drivers look, and the clock that they judge ages by. The defaults are the machine's own;
 tests put emulators and virtual time in their place. */
struct Surroundings {
  /** Folders that are searched for vendors' libraries before all others. */
  std::vector<std::filesystem::path> library_folders;
  std::filesystem::path root{"/"};  ///< Folder under which dev, sys, run, etc and var are.
  const Clock* clock{&SystemClock()};
};

/** One thing that a driver looked for. */
struct Finding {
  std::string what;   ///< "libHD.so.3.4", "USB device 1451:0402".
  std::string where;  ///< Path, address or search path.
  bool is_found{false};
  std::string note;  ///< Version, permission; may be empty.
};

/** What became of looking for the devices of one driver. */
struct ProbeReport {
  std::string driver;
  std::string title;
  std::vector<Finding> looked_for;
  std::vector<DeviceInfo> devices;  ///< That could be started.
  std::vector<Error> problems;  ///< One for each that could not: exact reason, where, and remedy.
};

/** What a driver is called, and how its addresses are written, with an example. */
struct DriverWords {
  std::string_view name;   ///< "openhaptics"
  std::string_view title;  ///< "OpenHaptics (3D Systems)"
  std::string_view address_help;
};

/** How devices of one kind are found and opened. Stateless. */
class Driver {
 public:
  explicit constexpr Driver(const DriverWords& words) : words_(words) {}

  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;

  [[nodiscard]] std::string_view name() const { return words_.name; }

  [[nodiscard]] std::string_view title() const { return words_.title; }

  [[nodiscard]] std::string_view address_help() const { return words_.address_help; }

  /** Looks for devices; `opens_devices`: starts each that it finds, without force, and lets go.
   What CheckInfo() refuses is a problem. */
  [[nodiscard]] ProbeReport Probe(const Surroundings& surroundings, bool opens_devices) const;

  /** Opens a device.
   @param address  What follows the driver's name and a colon; empty: the first one found.
   Errors: kNotFound, kUnsupported, kOutOfResource..., each with the remedy; those of CheckInfo().
 */
  [[nodiscard]] Result<std::unique_ptr<Device>> Open(const std::string& address,
                                                     const Surroundings& surroundings) const;

 protected:
  /** Probes, whatever the devices say of themselves. */
  [[nodiscard]] virtual ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                                   bool opens_devices) const = 0;

  /** Opens a device, whatever it says of itself. */
  [[nodiscard]] virtual Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const = 0;

  /** A report with nothing in it yet. */
  [[nodiscard]] ProbeReport BeginReport() const {
    return {std::string(name()), std::string(title()), {}, {}, {}};
  }

 private:
  DriverWords words_;
};

/** Checks what a device says of itself, whoever made its driver: all devices pass here, by
 Driver::Open and Driver::Probe. Figures are those of CheckProfile(), texts are UTF-8 without
 control characters, axes and buttons as Capabilities has them. Errors: kInvalid names the device,
 the field, its value and what is possible. */
[[nodiscard]] Result<void> CheckInfo(const DeviceInfo& info);

/** All drivers, in the order in which they are tried. */
[[nodiscard]] const std::vector<const Driver*>& Drivers();

/** Opens a device by "DRIVER" or "DRIVER:ADDRESS".
 Errors: kInvalid for a driver that does not exist (the message lists them), or the driver's. */
Result<std::unique_ptr<Device>> OpenDevice(const std::string& address,
                                           const Surroundings& surroundings);

}  // namespace hvas::device
