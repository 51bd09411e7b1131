#pragma once

#include "device/driver.h"

namespace hvas::device {

// Drivers that reach their devices by sockets, device files and plug-ins (docs/devices/).

[[nodiscard]] const Driver& HaplyDriver();
[[nodiscard]] const Driver& SpaceMouseDriver();
[[nodiscard]] const Driver& GamepadDriver();
[[nodiscard]] const Driver& NetworkDriver();
[[nodiscard]] const Driver& PluginDriver();

}  // namespace hvas::device
