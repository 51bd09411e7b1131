#pragma once

#include <cstdint>

#include "device/plugin/hvas_device_plugin.h"

/** What the emulated plug-in asks whoever started it: all that a device of its is. */
struct HvasEmulatedPlugin {
  void* context;
  void (*describe)(void* context, HvasDeviceDescription* description);
  std::int32_t (*read)(void* context, std::uint64_t* sequence, HvasDeviceSample* sample);
  void (*write)(void* context, const HvasDeviceWrench* wrench);
};

/** Exported by the emulated plug-in besides hvas_device_plugin(): puts a device under a name, that
 is the argument to open it by; null takes it away. */
extern "C" void hvas_emulator_register(const char* name, const HvasEmulatedPlugin* plugin);
