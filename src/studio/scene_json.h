#pragma once

#include "studio/workbench.h"

namespace hvas::studio {

/** The answer to GET /api/scene (docs/protocol.md). */
[[nodiscard]] Json MakeSceneJson(const OpenScene& scene, const LiveState& state);

}  // namespace hvas::studio
