#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "paths/pose_tree.h"

namespace hvas::paths {

/** What the searches share: the tree from the start, and the node of it that came furthest. */
struct SearchState {
  explicit SearchState(Probe* the_probe)
      : probe(the_probe), tree(*the_probe, the_probe->problem().X_WB_start) {}

  Probe* probe;
  PoseTree tree;
  std::size_t best{0};
  double best_to_go{-1};  ///< See WaySearch::distance_to_go; -1: not measured yet.
};

/** Whether the part is where it has to go: out, or at the goal. Notes what came furthest. */
[[nodiscard]] bool IsThere(SearchState* state, std::size_t node);

/** Pushes the part along each direction and about each axis, and from where it comes again, as long
 as fewer than `budget` queries are made. @returns poses from the start to where the part has to go,
 free at each pose. */
[[nodiscard]] std::optional<Path> SearchByPushes(SearchState* state,
                                                 const std::vector<Vec3>& directions,
                                                 const std::vector<ScrewAxis>& axes,
                                                 std::uint64_t budget);

}  // namespace hvas::paths
