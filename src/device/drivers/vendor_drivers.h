#pragma once

#include "device/driver.h"

namespace hvas::device {

// The drivers that load a vendor's library when the program runs; one each, for ever.
[[nodiscard]] const Driver& OpenHapticsDriver();
[[nodiscard]] const Driver& ForceDimensionDriver();
[[nodiscard]] const Driver& VirtuoseDriver();

}  // namespace hvas::device
