#pragma once

#include "paths/probe.h"

namespace hvas::paths {

/** Puts the beginning of a way onto one of the problem's axes: as far from the first pose as the
 part is nearly coaxial with how it stands there, and as the result is free, it turns about the axis
 and goes along it, and does nothing else, in the middle between walls. A search leaves it tilted
 within its play, where a hand that feels the bore would not. From there it goes straight out along
 the axis where it can and no goal is given, else as before. The result passes CheckWay().
 Deterministic.
 @param path  Passes CheckWay(). */
[[nodiscard]] Path AlignWay(Probe* probe, const Path& path, double step);

}  // namespace hvas::paths
