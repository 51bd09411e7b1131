// A plug-in as anybody would write one, whose devices are emulated ones in the same process.
#include "device/emulation/emulated_plugin.h"

#include <cstdio>
#include <map>
#include <mutex>
#include <string>

namespace {

struct Registry {
  std::mutex mutex;
  std::map<std::string, HvasEmulatedPlugin> plugins;
};

Registry& Plugins() {
  static Registry registry;
  return registry;
}

struct OpenDevice {
  HvasEmulatedPlugin plugin;
  std::uint64_t sequence{0};
};

void* Open(const char* argument, char* error, std::uint32_t error_size) {
  const std::scoped_lock lock(Plugins().mutex);
  const auto found = Plugins().plugins.find(argument);
  if (found == Plugins().plugins.end()) {
    std::snprintf(error, error_size,
                  "no emulated device is called \"%s\"; start its emulator first", argument);
    return nullptr;
  }
  return new OpenDevice{found->second};
}

void Close(void* device) {
  delete static_cast<OpenDevice*>(device);
}

void Describe(void* device, HvasDeviceDescription* description) {
  const auto* open = static_cast<OpenDevice*>(device);
  open->plugin.describe(open->plugin.context, description);
}

std::int32_t Read(void* device, HvasDeviceSample* sample) {
  auto* open = static_cast<OpenDevice*>(device);
  return open->plugin.read(open->plugin.context, &open->sequence, sample);
}

void Write(void* device, const HvasDeviceWrench* wrench) {
  const auto* open = static_cast<OpenDevice*>(device);
  open->plugin.write(open->plugin.context, wrench);
}

}  // namespace

extern "C" {

void hvas_emulator_register(const char* name, const HvasEmulatedPlugin* plugin) {
  const std::scoped_lock lock(Plugins().mutex);
  if (plugin != nullptr) {
    Plugins().plugins[name] = *plugin;
  } else {
    Plugins().plugins.erase(name);
  }
}

const HvasDevicePlugin* hvas_device_plugin(std::uint32_t) {
  static const HvasDevicePlugin plugin{
      sizeof(HvasDevicePlugin), HVAS_DEVICE_PLUGIN_VERSION, Open, Close, Describe, Read, Write};
  return &plugin;
}
}
