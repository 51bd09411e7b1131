#pragma once

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "simulation/simulation.h"

namespace hvas::studio {

/** Values in the notation of docs/protocol.md: SI units, quaternions as w, x, y, z. */
[[nodiscard]] const char* ToString(simulation::Placement placement);
[[nodiscard]] nlohmann::ordered_json ToJson(const Error& error);
[[nodiscard]] nlohmann::ordered_json ToJson(const Vec3& v);
[[nodiscard]] nlohmann::ordered_json ToJson(const spatial::Pose& X);

/** Event of docs/protocol.md; null for events that clients do not get. */
[[nodiscard]] nlohmann::ordered_json ToJson(const simulation::SimulationEvent& event);

}  // namespace hvas::studio
