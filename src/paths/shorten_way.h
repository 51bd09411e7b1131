#pragma once

#include <cstdint>
#include <optional>

#include "paths/probe.h"

namespace hvas::paths {

/** Makes a way that is free at its poses free between them, too: where a screw from one to the next
 is not, poses between them are pushed out of contact. The result passes CheckWay(). None where that
 does not succeed; then `edge` is the pose before what is blocked. */
[[nodiscard]] std::optional<Path> RepairWay(Probe* probe, const Path& path, double step,
                                            std::size_t* edge);

/** Takes detours out of a way that passes CheckWay(): screws between two places of it take the
 place of what is between them where they are free, and keep what distance the way has there, up to
 a hundredth of the part. The result passes CheckWay() and is no longer. Deterministic. */
[[nodiscard]] Path ShortenWay(Probe* probe, const Path& path, double step, std::uint64_t seed,
                              std::uint64_t budget);

/** Length of a way in the metric of Probe::CalcLength() [m]. */
[[nodiscard]] double CalcWayLength(const Probe& probe, const Path& path);

}  // namespace hvas::paths
