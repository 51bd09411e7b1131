#pragma once

#include "haptics/held_part.h"
#include "sweep/path.h"

namespace hvas::simulation {

/** The way of a part that turns out of its thread: poses X_WB from its place along the helix until
 the thread is out, and straight on from there, `engage_distance` from its place at least [m]. Where
 the head has to be loosened first, it begins with a turn on the spot. Empty where the part has no
 thread. */
[[nodiscard]] sweep::Path MakeThreadWay(const haptics::HeldPart& held, double engage_distance);

}  // namespace hvas::simulation
