#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "simulation/simulation.h"
#include "studio/json.h"

namespace hvas::studio {

/** Values in the notation of docs/protocol.md: SI units, quaternions as w, x, y, z. */
[[nodiscard]] const char* ToString(simulation::Placement placement);
/** Leaves the folders of the host's files out (HideFolders). */
[[nodiscard]] Json ToJson(const Error& error);
[[nodiscard]] Json ToJson(const std::vector<product::OccurrenceId>& ids);
[[nodiscard]] Json ToJson(const Vec3& v);
[[nodiscard]] Json ToJson(const spatial::Pose& X);

/** Replaces absolute paths in a text by the names of their files: a page learns nothing of where
 files lie on the host. */
[[nodiscard]] std::string HideFolders(std::string_view text);

/** Event of docs/protocol.md; null for events that clients do not get. */
[[nodiscard]] Json ToJson(const simulation::SimulationEvent& event);

}  // namespace hvas::studio
