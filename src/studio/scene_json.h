#pragma once

#include "studio/json.h"
#include "studio/live_run.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Makes the response to GET /api/scene (docs/protocol.md). */
[[nodiscard]] Json MakeSceneJson(const OpenScene& scene, const LiveState& state);

/** Makes the response to GET /api/scene for a participant of a study: without fits, without the
 evidence for mates, and without the populations that sizes were drawn from. */
[[nodiscard]] Json MakeShieldedSceneJson(const OpenScene& scene, const LiveState& state);

}  // namespace hvas::studio
