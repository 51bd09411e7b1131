#pragma once

#include <cstdint>

#include "paths/probe.h"

namespace hvas::paths {

/** Moves a way that passes CheckWay() to where it is clear of others, as far as it can: its poses,
 first divided, go away from what is nearer than a share of the part's size, into the middle between
 walls, and none comes nearer to others by it. The first and last pose stay. The result passes
 CheckWay(). Deterministic. */
[[nodiscard]] Path WidenWay(Probe* probe, const Path& path, double step, std::uint64_t budget);

}  // namespace hvas::paths
