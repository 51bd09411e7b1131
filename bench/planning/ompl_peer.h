#pragma once

#include <cstdint>
#include <optional>

#include "puzzles.h"

namespace hvas::bench {

struct PeerRun {
  bool is_solved{false};
  double seconds{0};
  std::uint64_t queries{0};  ///< Collision queries.
  std::size_t poses{0};      ///< What it found; the path has more of them, close together.
  double check_step{0};      ///< Distance of two poses that are checked [m].
  paths::Path path;
};

struct PeerOptions {
  std::uint32_t seed{1};  ///< OMPL takes the first of a process; later runs go on from it.
  double limit_s{60};
  /** Distance of the poses at which a motion is checked, as a share of the extent of the space.
   OMPL's own default is 0.01, with which some of its ways pass through the mesh. */
  double resolution{0.01};
};

/** OMPL's RRT-Connect in SE(3) with its own defaults and FCL on the same meshes, within the bounds
 of all boxes and as much around them as ours has. @pre the puzzle has a goal pose. */
[[nodiscard]] PeerRun SolveByOmpl(const Puzzle& puzzle, const PeerOptions& options);

}  // namespace hvas::bench
