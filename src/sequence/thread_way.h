#pragma once

#include "haptics/held_part.h"
#include "paths/path.h"

namespace hvas::sequence {

/** The way of a part that turns out of its thread: poses X_WB from its place along the helix until
 the thread is out, and straight on from there, `engage_distance` from its place at least [m]. Where
 the head has to be loosened first, it begins with a turn on the spot. Empty where the part has no
 thread. */
[[nodiscard]] paths::Path MakeThreadWay(const haptics::HeldPart& held, double engage_distance);

}  // namespace hvas::sequence
