#pragma once

#include "studio/workbench.h"

namespace hvas::studio {

/** The answer to GET /api/scene (docs/protocol.md). */
[[nodiscard]] Json MakeSceneJson(const OpenScene& scene, const LiveState& state);

/** The same for whoever takes part in a study: nothing of fits, of how mates were found, or of what
 sizes were drawn from. */
[[nodiscard]] Json MakeShieldedSceneJson(const OpenScene& scene, const LiveState& state);

}  // namespace hvas::studio
