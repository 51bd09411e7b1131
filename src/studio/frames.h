#pragma once

#include <string>
#include <vector>

#include "simulation/executors.h"
#include "studio/frame_codec.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** The message with what has changed since a client was told last; empty when that is nothing.
 @param t_ns  What its frames have for their time.
 @param told  The poses that the client has, brought up to date; empty: it has none. */
[[nodiscard]] std::string MakeFrames(const LiveFrame& frame, std::int64_t t_ns, std::uint32_t seq,
                                     std::vector<spatial::Pose>* told);

/** Where an input wants the hand. @pre it came through ReadClientFrames. */
[[nodiscard]] spatial::Pose PoseOf(const protocol::HandInput& input);

/** What "status" says of a hand. */
[[nodiscard]] Json MakeHandStatus(const LiveFrame& frame, std::size_t hand);

/** The event "status" of docs/protocol.md, without what the hub knows. */
[[nodiscard]] Json MakeStatus(const simulation::LoopStatus& status);

}  // namespace hvas::studio
