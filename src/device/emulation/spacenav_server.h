#pragma once

#include "device/emulation/wire_emulator.h"

namespace hvas::device {

/** What spacenavd is: a UNIX socket that sends frames of 32 bytes. The cap is pushed towards where
 the hand wants the integrated pose to be. */
Result<std::unique_ptr<WireServer>> MakeSpacenavServer(const WireSite& site);

}  // namespace hvas::device
