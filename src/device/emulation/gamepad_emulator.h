#pragma once

#include "device/emulation/wire_emulator.h"

namespace hvas::device {

/** What the kernel is for a gamepad at dev/input/event0: events, and answers to the ioctl calls
 that EvdevNode sends to a socket. Sticks are pushed towards where the hand wants the integrated
 pose to be; rumble arrives at the emulated motors as a force upwards of 0 to 1 N. */
Result<std::unique_ptr<WireServer>> MakeGamepadServer(const WireSite& site);

}  // namespace hvas::device
