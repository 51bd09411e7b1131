#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "device/driver.h"

namespace hvas::app {

/** What looking for devices gave, as a text for a person: for each driver the devices that could be
 started, why others could not and what to do about it, what was looked for and where; and at the
 end what to do next. */
[[nodiscard]] std::string DescribeProbe(const std::vector<device::ProbeReport>& reports,
                                        bool has_opened);

/** The report as JSON by data/schemas/devices.schema.json. */
[[nodiscard]] nlohmann::ordered_json MakeProbeJson(const std::vector<device::ProbeReport>& reports,
                                                   bool has_opened);

/** One device in a few lines. */
[[nodiscard]] std::string DescribeDevice(const device::DeviceInfo& info);

/** "DRIVER:ADDRESS", that opens it again. */
[[nodiscard]] std::string AddressOf(const device::DeviceInfo& info);

}  // namespace hvas::app
