#pragma once

#include <utility>
#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

/** What parts leave of the ways of other parts: by boxes and rays on their meshes. */
namespace hvas::product {

/** Finds parts in a closed cavity of another one: from no point of theirs a ray leaves it. The
 second is the smallest part around the first. Incomplete when the watch ends it. */
[[nodiscard]] std::vector<std::pair<OccurrenceId, OccurrenceId>> FindEnclosed(
    const Product& product, WorkWatch* watch = nullptr);

/** Whether a part can go away from others in a straight line: along one of its axes and normals, of
 theirs, or of W. One in twenty of its points may be blocked, as where faces touch. True when the
 watch ends it. */
[[nodiscard]] bool HasStraightWayOut(const Product& product, OccurrenceId id,
                                     const std::vector<OccurrenceId>& others,
                                     WorkWatch* watch = nullptr);

/** Counts the others that have a hole on the axis of a fastener, along its shank. */
[[nodiscard]] int CountHeld(const Product& product, OccurrenceId fastener,
                            const std::vector<OccurrenceId>& others);

}  // namespace hvas::product
