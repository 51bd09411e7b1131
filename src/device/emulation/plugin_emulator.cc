#include "device/emulation/plugin_emulator.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include "device/emulation/emulated_plugin.h"

namespace hvas::device {
namespace {

using Register = void (*)(const char* name, const HvasEmulatedPlugin* plugin);

// A force is let go after this time without a word, as in the drivers.
constexpr std::int64_t kWatchdogNs = 20'000'000;

void Put(const Vec3& v, double (*values)[3]) {
  std::copy_n(v.data(), 3, *values);
}

void Describe(void* context, HvasDeviceDescription* d) {
  const DeviceProfile profile = static_cast<EmulatedDevice*>(context)->profile();
  d->flags = HVAS_DEVICE_SENSES_ROTATION | HVAS_DEVICE_HAS_GRIP | HVAS_DEVICE_HAS_PRESENCE_SWITCH |
             HVAS_DEVICE_HAS_EMERGENCY_STOP | HVAS_DEVICE_IS_EMULATED;
  d->force_axes = profile.max_force > 0 ? 3 : 0;
  d->torque_axes = profile.max_torque > 0 ? 3 : 0;
  d->button_count = 2;
  std::snprintf(d->model, sizeof(d->model), "%s", profile.name.c_str());
  std::snprintf(d->serial, sizeof(d->serial), "EMULATED");
  std::snprintf(d->version, sizeof(d->version), "1");
  d->max_force = profile.max_force;
  d->continuous_force = profile.continuous_force;
  d->max_torque = profile.max_torque;
  d->continuous_torque = profile.continuous_torque;
  d->max_stiffness = profile.max_stiffness;
  d->max_damping = profile.max_damping;
  d->max_rotational_stiffness = profile.max_rotational_stiffness;
  d->max_rotational_damping = profile.max_rotational_damping;
  d->position_resolution = profile.position_resolution;
  d->rotation_resolution = profile.rotation_resolution;
  Put(profile.workspace, &d->workspace);
  d->rate_hz = profile.rate_hz;
  d->delay = profile.delay;
}

std::int32_t StatusOf(const EmulatedSample& sample, std::uint64_t* sequence) {
  switch (sample.fault) {
    case Fault::kUnplugged:
      return HVAS_DEVICE_LOST;
    case Fault::kCalibrationLost:
      return HVAS_DEVICE_NOT_CALIBRATED;
    case Fault::kForceRefused:
      return HVAS_DEVICE_NO_FORCE;
    default:
      break;
  }
  if (std::exchange(*sequence, sample.sequence) == sample.sequence) {
    return HVAS_DEVICE_NO_NEW_SAMPLE;
  }
  if (sample.is_stopped) {
    return HVAS_DEVICE_STOPPED;
  }
  return sample.is_holding ? HVAS_DEVICE_READY : HVAS_DEVICE_NOT_HELD;
}

std::int32_t Read(void* context, std::uint64_t* sequence, HvasDeviceSample* sample) {
  const EmulatedSample sensed = static_cast<EmulatedDevice*>(context)->Sense();
  Put(sensed.X_DH.p(), &sample->position);
  const Quat& q = sensed.X_DH.q();
  const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(orientation, 4, sample->orientation);
  Put(sensed.V_DH.v, &sample->velocity);
  Put(sensed.V_DH.w, &sample->angular_velocity);
  sample->buttons = sensed.buttons;
  sample->grip = sensed.grip;
  return StatusOf(sensed, sequence);
}

void Write(void* context, const HvasDeviceWrench* wrench) {
  static_cast<EmulatedDevice*>(context)->Command(
      {Vec3(wrench->torque[0], wrench->torque[1], wrench->torque[2]),
       Vec3(wrench->force[0], wrench->force[1], wrench->force[2])});
}

class PluginServer final : public WireServer {
 public:
  PluginServer(void* library, Register registers, const WireSite& site)
      : library_(library), register_(registers), name_(NextName()) {
    site.device->SetCommandTimeout(kWatchdogNs);
    const HvasEmulatedPlugin plugin{site.device, Describe, Read, Write};
    register_(name_.c_str(), &plugin);
  }

  ~PluginServer() override {
    register_(name_.c_str(), nullptr);
    ::dlclose(library_);
  }

  [[nodiscard]] std::string address() const override {
    return fmt::format("plugin:{}?{}", HVAS_EMULATED_PLUGIN, name_);
  }

  void Serve() override {}  // the plug-in is called, nobody waits for it

  void Emit(std::int64_t) override {}

 private:
  static std::string NextName() {
    static std::atomic<int> count{0};
    return fmt::format("emulated-{}", ++count);
  }

  void* library_;
  Register register_;
  std::string name_;
};

}  // namespace

Result<std::unique_ptr<WireServer>> MakePluginServer(const WireSite& site) {
  void* const library = ::dlopen(HVAS_EMULATED_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    return Fail(ErrorCode::kNotFound, "the emulated plug-in cannot be loaded", HVAS_EMULATED_PLUGIN,
                "build HVAS again");
  }
  auto* const registers = reinterpret_cast<Register>(::dlsym(library, "hvas_emulator_register"));
  if (registers == nullptr) {
    ::dlclose(library);
    return Fail(ErrorCode::kUnsupported, "the emulated plug-in is a different one",
                HVAS_EMULATED_PLUGIN, "build HVAS again");
  }
  return std::make_unique<PluginServer>(library, registers, site);
}

}  // namespace hvas::device
