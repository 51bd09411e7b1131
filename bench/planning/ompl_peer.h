#pragma once

#include <cstdint>
#include <optional>

#include "puzzles.h"

namespace hvas::bench {

struct PeerRun {
  bool is_solved{false};
  double seconds{0};
  std::uint64_t queries{0};  ///< Collision queries.
  sweep::Path path;
};

/** OMPL's RRT-Connect in SE(3) with its own defaults and FCL on the same meshes, within the bounds
 of all boxes and as much around them as ours has. @pre the puzzle has a goal pose. */
[[nodiscard]] PeerRun SolveByOmpl(const Puzzle& puzzle, std::uint32_t seed, double limit);

}  // namespace hvas::bench
