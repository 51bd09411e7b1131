#pragma once

#include <string>
#include <vector>

#include "simulation/flight_recorder.h"

namespace hvas::session {

/** A recording of the flight recorder as a JSON object: `columns`, names with units, and `ticks`,
 one array of numbers each (null where one is not finite). */
[[nodiscard]] std::string MakeFlightJson(const std::vector<simulation::FlightTick>& ticks);

}  // namespace hvas::session
