#pragma once

#include "device/emulation/wire_emulator.h"

namespace hvas::device {

/** A plug-in around the emulated device: a library of its own, loaded as any other. */
Result<std::unique_ptr<WireServer>> MakePluginServer(const WireSite& site);

}  // namespace hvas::device
