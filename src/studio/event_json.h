#pragma once

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "simulation/simulation.h"

namespace hvas::studio {

/** The numbers and words of docs/protocol.md. */
[[nodiscard]] const char* ToString(simulation::Placement placement);
[[nodiscard]] nlohmann::ordered_json ToJson(const Error& error);
[[nodiscard]] nlohmann::ordered_json ToJson(const Vec3& v);
[[nodiscard]] nlohmann::ordered_json ToJson(const spatial::Pose& X);

/** Null for events that viewers are not told of. */
[[nodiscard]] nlohmann::ordered_json ToJson(const simulation::SimulationEvent& event);

}  // namespace hvas::studio
