#pragma once

#include <cstdint>
#include <optional>

#include "paths/probe.h"

namespace hvas::paths {

/** Follows the motion that the faces around the part leave it, as the flanks of a thread leave a
 screw, in either sense until the part is out. The motion is the screw along whose velocity the
 distances to what is near change least, in the sense of absolute values: the slippable motion of
 Gelfand and Guibas, Shape segmentation using local slippage analysis, 2004, with iteratively
 reweighted least squares, so that a head on its seat does not count beside a thread. It is
 estimated again on the way, and the part is kept in the middle between what is near.
 It is checked, and mended, to its end, whatever of the budget is left: a thread of ten turns takes
 longer to check than to find.
 @param budget  Contact queries of the search.
 @param step  Of the check (CheckWay()) [m].
 @returns none where there is no such motion, where it is blocked, and for a problem with a goal
 pose. */
[[nodiscard]] std::optional<Way> FindFreeMotion(Probe* probe, const WayOptions& options,
                                                std::uint64_t budget, double step);

}  // namespace hvas::paths
