// Devices behind the C interface of device/plugin/hvas_device_plugin.h (docs/devices/plugin.md).
#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "device/drivers/polled_guard.h"
#include "device/drivers/wire_drivers.h"
#include "device/plugin/hvas_device_plugin.h"

namespace hvas::device {
namespace {

constexpr const char* kName = "plugin";
constexpr const char* kEntry = "hvas_device_plugin";
constexpr const char* kFolder = "usr/lib/hvas/plugins";

struct CloseLibrary {
  void operator()(void* library) const { ::dlclose(library); }
};

using Library = std::unique_ptr<void, CloseLibrary>;

/** A text of a fixed number of bytes, whether or not it ends with a zero byte. */
template <std::size_t kSize>
std::string TextOf(const char (&text)[kSize]) {
  const std::string all(text, kSize);
  return all.substr(0, all.find('\0'));
}

Condition ConditionOf(std::int32_t status) noexcept {
  switch (status) {
    case HVAS_DEVICE_READY:
      return Condition::kReady;
    case HVAS_DEVICE_NO_FORCE:
      return Condition::kNoForce;
    case HVAS_DEVICE_NOT_HELD:
      return Condition::kNotHeld;
    case HVAS_DEVICE_NOT_CALIBRATED:
      return Condition::kNotCalibrated;
    case HVAS_DEVICE_LOST:
      return Condition::kLost;
    case HVAS_DEVICE_STOPPED:
      return Condition::kStopped;
    default:
      return Condition::kFault;
  }
}

Vec3 VectorOf(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}

DeviceState StateOf(const HvasDeviceSample& sample, std::int32_t status) noexcept {
  const double(&q)[4] = sample.orientation;
  DeviceState state;
  state.X_DH = PoseFromWire(Quat(q[0], q[1], q[2], q[3]), VectorOf(sample.position));
  state.V_DH = {VectorOf(sample.angular_velocity), VectorOf(sample.velocity)};
  state.buttons = sample.buttons;
  state.grip = sample.grip;
  state.vendor_code = sample.vendor_code;
  state.condition = ConditionOf(status);
  return state;
}

class PluginDevice final : public Device {
 public:
  PluginDevice(Library library, const HvasDevicePlugin* plugin, void* device, DeviceInfo info,
               const Clock& clock)
      : library_(std::move(library)),
        plugin_(*plugin),
        device_(device),
        info_(std::move(info)),
        guard_(info_.profile, clock) {}

  ~PluginDevice() override {
    Show({});
    plugin_.close(device_);
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override {
    guard_.Begin();
    HvasDeviceSample sample{};
    sample.size = sizeof(sample);
    sample.orientation[0] = 1;
    sample.grip = std::numeric_limits<double>::quiet_NaN();
    const std::int32_t status = plugin_.read(device_, &sample);
    switch (status) {
      case HVAS_DEVICE_READY:
      case HVAS_DEVICE_NO_FORCE:
      case HVAS_DEVICE_NOT_HELD:
        return guard_.Accept(StateOf(sample, status));
      case HVAS_DEVICE_NO_NEW_SAMPLE:
        return guard_.Repeat();
      default:
        return guard_.Refuse(ConditionOf(status), sample.vendor_code);
    }
  }

  void Write(const spatial::Wrench& F_H_D) noexcept override { Show(guard_.Permit(F_H_D)); }

 private:
  void Show(const spatial::Wrench& F_H_D) noexcept {
    const HvasDeviceWrench wrench{{F_H_D.t.x(), F_H_D.t.y(), F_H_D.t.z()},
                                  {F_H_D.f.x(), F_H_D.f.y(), F_H_D.f.z()}};
    plugin_.write(device_, &wrench);
  }

  Library library_;
  HvasDevicePlugin plugin_;
  void* device_;
  DeviceInfo info_;
  PolledGuard guard_;
};

HvasDeviceDescription DefaultDescription() {
  const DeviceProfile& profile = FindProfile("network")->profile;
  HvasDeviceDescription d{};
  d.size = sizeof(d);
  d.force_axes = 3;
  d.max_force = profile.max_force;
  d.continuous_force = profile.continuous_force;
  d.max_stiffness = profile.max_stiffness;
  d.max_damping = profile.max_damping;
  d.position_resolution = profile.position_resolution;
  d.rotation_resolution = profile.rotation_resolution;
  for (std::size_t k = 0; k < 3; ++k) {
    d.workspace[k] = profile.workspace[static_cast<Eigen::Index>(k)];
  }
  d.rate_hz = profile.rate_hz;
  d.delay = profile.delay;
  return d;
}

DeviceProfile ProfileOf(const HvasDeviceDescription& d) {
  DeviceProfile profile = FindProfile("network")->profile;
  profile.id = kName;
  profile.name = TextOf(d.model);
  profile.max_force = d.force_axes > 0 ? d.max_force : 0;
  profile.continuous_force = d.force_axes > 0 ? d.continuous_force : 0;
  profile.max_torque = d.torque_axes > 0 ? d.max_torque : 0;
  profile.continuous_torque = d.torque_axes > 0 ? d.continuous_torque : 0;
  profile.max_stiffness = d.max_stiffness;
  profile.max_damping = d.max_damping;
  profile.max_rotational_stiffness = d.max_rotational_stiffness;
  profile.max_rotational_damping = d.max_rotational_damping;
  profile.position_resolution = d.position_resolution;
  profile.rotation_resolution = d.rotation_resolution;
  profile.workspace = VectorOf(d.workspace);
  profile.rate_hz = d.rate_hz;
  profile.delay = d.delay;
  return profile;
}

DeviceInfo InfoOf(const HvasDeviceDescription& d, const std::string& address) {
  const auto has = [&d](std::uint32_t flag) { return (d.flags & flag) != 0; };
  DeviceInfo info;
  info.driver = kName;
  info.address = fmt::format("{}:{}", kName, address);
  info.model = TextOf(d.model);
  info.serial = TextOf(d.serial);
  info.version = TextOf(d.version);
  info.is_emulated = has(HVAS_DEVICE_IS_EMULATED);
  info.capabilities.force_axes = static_cast<int>(d.force_axes);
  info.capabilities.torque_axes = static_cast<int>(d.torque_axes);
  info.capabilities.senses_rotation = has(HVAS_DEVICE_SENSES_ROTATION);
  info.capabilities.has_grip = has(HVAS_DEVICE_HAS_GRIP);
  info.capabilities.has_presence_switch = has(HVAS_DEVICE_HAS_PRESENCE_SWITCH);
  info.capabilities.has_emergency_stop = has(HVAS_DEVICE_HAS_EMERGENCY_STOP);
  info.capabilities.button_count = static_cast<int>(d.button_count);
  info.profile = ProfileOf(d);
  info.profile_note =
      "limits, workspace, resolution, rate and delay are as reported by the plug-in";
  return info;
}

/** The table of a library that is loaded, when HVAS can use it. */
Result<const HvasDevicePlugin*> FindTable(void* library, const std::string& file) {
  using Entry = const HvasDevicePlugin* (*)(std::uint32_t);
  auto* const entry = reinterpret_cast<Entry>(::dlsym(library, kEntry));
  if (entry == nullptr) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("this library is not an HVAS plug-in: it has no function {}", kEntry),
                file, "build it with hvas_device_plugin.h, or give another file");
  }
  const HvasDevicePlugin* plugin = entry(HVAS_DEVICE_PLUGIN_VERSION);
  if (plugin == nullptr) {
    return Fail(ErrorCode::kUnsupported, "the plug-in returns no function table", file,
                "contact the author of the plug-in");
  }
  if (plugin->version != HVAS_DEVICE_PLUGIN_VERSION || plugin->size < sizeof(HvasDevicePlugin)) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the plug-in was built for version {} of the interface, HVAS has "
                            "version {}",
                            plugin->version, HVAS_DEVICE_PLUGIN_VERSION),
                file, "build it again with the hvas_device_plugin.h of this HVAS");
  }
  if (plugin->open == nullptr || plugin->close == nullptr || plugin->describe == nullptr ||
      plugin->read == nullptr || plugin->write == nullptr) {
    return Fail(ErrorCode::kUnsupported, "the plug-in's function table is incomplete", file,
                "it needs open, close, describe, read and write");
  }
  return plugin;
}

Result<Library> Load(const std::string& file) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) {
    return Fail(ErrorCode::kNotFound, "there is no such plug-in", file,
                "give the path of its library, for example plugin:/path/to/device.so");
  }
  Library library(::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (library == nullptr) {
    const char* reason = ::dlerror();
    return Fail(ErrorCode::kUnreadable,
                fmt::format("the plug-in cannot be loaded: {}", reason != nullptr ? reason : "?"),
                file, "it has to be a shared library for this machine, with all its dependencies");
  }
  return library;
}

Result<std::unique_ptr<Device>> OpenPlugin(const std::string& address,
                                           const Surroundings& surroundings) {
  const std::size_t mark = address.find('?');
  const std::string file = address.substr(0, mark);
  const std::string argument = mark == std::string::npos ? "" : address.substr(mark + 1);
  auto library = Load(file);
  if (!library) {
    return Unexpected(library.error());
  }
  const auto plugin = FindTable(library->get(), file);
  if (!plugin) {
    return Unexpected(plugin.error());
  }
  char error[512] = "";
  void* const device = (*plugin)->open(argument.c_str(), error, sizeof(error));
  if (device == nullptr) {
    const std::string reason = TextOf(error);
    return Fail(ErrorCode::kNotFound, reason.empty() ? "the plug-in finds no device" : reason, file,
                reason.empty() ? "check the device's cable and power" : "");
  }
  HvasDeviceDescription description = DefaultDescription();
  (*plugin)->describe(device, &description);
  return std::make_unique<PluginDevice>(std::move(*library), *plugin, device,
                                        InfoOf(description, address), *surroundings.clock);
}

class Plugins final : public Driver {
 public:
  Plugins()
      : Driver({kName, "Plug-in (a shared library for a device that HVAS does not know)",
                "FILE[?ARGUMENT], for example plugin:/opt/lab/our_arm.so?port=3"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override {
    ProbeReport report = BeginReport();
    const std::filesystem::path folder = surroundings.root / kFolder;
    for (const std::filesystem::path& file : FilesIn(folder)) {
      report.looked_for.push_back({"plug-in " + file.filename().string(), file.string(), true, ""});
      if (!opens_devices) {
        continue;
      }
      if (auto device = OpenPlugin(file.string(), surroundings)) {
        report.devices.push_back((*device)->info());
      } else {
        report.problems.push_back(device.error());
      }
    }
    if (report.looked_for.empty()) {
      report.looked_for.push_back({"plug-ins", folder.string(), false, ""});
      report.problems.push_back(
          {ErrorCode::kNotFound, "no plug-in is installed", folder.string(),
           "put the library of a plug-in there, or give its path: plugin:/path/to/device.so"});
    }
    return report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override {
    if (!address.empty()) {
      return OpenPlugin(address, surroundings);
    }
    const std::filesystem::path folder = surroundings.root / kFolder;
    const auto files = FilesIn(folder);
    if (files.empty()) {
      return Fail(ErrorCode::kNotFound, "no plug-in is given, and none is installed",
                  folder.string(),
                  "give the path of its library, for example plugin:/path/to/device.so");
    }
    return OpenPlugin(files.front().string(), surroundings);
  }

 private:
  /** The libraries in a folder, in the order of their names. */
  static std::vector<std::filesystem::path> FilesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code failure;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
      if (entry.path().extension() == ".so") {
        files.push_back(entry.path());
      }
    }
    std::sort(files.begin(), files.end());
    return files;
  }
};

}  // namespace

const Driver& PluginDriver() {
  static const Plugins driver;
  return driver;
}

}  // namespace hvas::device
