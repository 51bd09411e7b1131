#pragma once

#include <vector>

#include "device/driver.h"

namespace hvas::app {

/** What looking for devices gave, as a text for a person: each driver, what was looked for and
 where, what was found, and for what could not start, why and what to do. */
void PrintProbeText(const std::vector<device::ProbeReport>& reports, bool has_opened);

/** The same by data/schemas/devices.schema.json. */
void PrintProbeJson(const std::vector<device::ProbeReport>& reports, bool has_opened);

/** One device in a few lines. */
void PrintDeviceText(const device::DeviceInfo& info);

}  // namespace hvas::app
