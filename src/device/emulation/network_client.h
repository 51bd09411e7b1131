#pragma once

#include "device/emulation/wire_emulator.h"

namespace hvas::device {

/** A device that speaks the protocol of docs/devices/network.md. */
Result<std::unique_ptr<WireServer>> MakeNetworkClient(const WireSite& site);

}  // namespace hvas::device
