#pragma once

#include <vector>

#include "base/result.h"
#include "simulation/simulation.h"
#include "studio/json.h"

namespace hvas::studio {

/** Values in the notation of docs/protocol.md: SI units, quaternions as w, x, y, z. */
[[nodiscard]] const char* ToString(simulation::Placement placement);
[[nodiscard]] Json ToJson(const Error& error);
[[nodiscard]] Json ToJson(const std::vector<product::OccurrenceId>& ids);
[[nodiscard]] Json ToJson(const Vec3& v);
[[nodiscard]] Json ToJson(const spatial::Pose& X);

/** Event of docs/protocol.md; null for events that clients do not get. */
[[nodiscard]] Json ToJson(const simulation::SimulationEvent& event);

}  // namespace hvas::studio
