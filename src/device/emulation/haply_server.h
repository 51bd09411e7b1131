#pragma once

#include "device/emulation/wire_emulator.h"

namespace hvas::device {

/** What the Inverse Service 3.5 is, which tells its version and takes forces as "vector". */
Result<std::unique_ptr<WireServer>> MakeHaplyServer(const WireSite& site);

/** One of 3.1, which tells no version and takes forces as "values" alone; its first snapshot lists
 no devices. */
Result<std::unique_ptr<WireServer>> MakeOldHaplyServer(const WireSite& site);

}  // namespace hvas::device
