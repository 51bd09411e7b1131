#pragma once

#include <string>
#include <vector>

#include "simulation/executors.h"
#include "studio/frame_codec.h"
#include "studio/json.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Makes the binary message with all poses and deformations that have changed since the client's
 last one; empty when none has.
 @param t_ns  Time in the header of its frames [ns].
 @param[in,out] known  What the client has. */
[[nodiscard]] std::string MakeFrames(const LiveFrame& frame, std::int64_t t_ns, std::uint32_t seq,
                                     ShownState* known);

/** Target pose X_WH of an input. @pre ReadClientFrames has checked it. */
[[nodiscard]] spatial::Pose PoseOf(const protocol::HandInput& input);

/** Makes the entry of a hand in the event "status". */
[[nodiscard]] Json MakeHandStatus(const LiveFrame& frame, std::size_t hand);

/** Makes the event "status" of docs/protocol.md, without the fields that the hub adds. */
[[nodiscard]] Json MakeStatus(const simulation::LoopStatus& status);

}  // namespace hvas::studio
