#pragma once

#include <optional>
#include <vector>

#include "paths/push_search.h"

namespace hvas::paths {

/** Grows the tree of a search, and one from the goal pose where there is one, until the part is
 where it has to go; see docs/algorithms/planning.md. The way passes CheckWay().
 @param directions  Straight ways out are tried along them. */
[[nodiscard]] std::optional<Path> SearchByTree(SearchState* state,
                                               const std::vector<Vec3>& directions,
                                               const std::vector<ScrewAxis>& axes,
                                               const WayOptions& options);

}  // namespace hvas::paths
