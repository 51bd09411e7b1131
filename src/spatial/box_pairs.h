#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "base/work_watch.h"
#include "spatial/box.h"

/** The one place where every part is compared with every other one: no other loop over parts stands
 in a loop over parts (tools/lint/part_loops.py). A tree of boxes leaves out what is far apart, and
 the watch counts the rest. */
namespace hvas::spatial {

/** Takes two indices; returns false to end the visit. */
using PairFn = std::function<bool(std::size_t i, std::size_t k)>;

/** Visits all pairs i < k of boxes that come within `margin` of each other, in ascending order.
 Empty boxes pair with nothing. Takes O(n log n) and what it visits, and memory for n boxes.
 @param watch  Ends the visit by its limits of time, memory and pairs; null: nothing does.
 @returns whether nothing has ended the visit. */
bool ForEachPair(std::span<const Box> boxes, double margin, WorkWatch* watch, const PairFn& visit);

/** Visits as ForEachPair(boxes, ...) the pairs of a box of `first` and a box of `second`, whatever
 their indices are. */
bool ForEachPair(std::span<const Box> first, std::span<const Box> second, double margin,
                 WorkWatch* watch, const PairFn& visit);

/** Whether the boxes hang together by pairs within `margin` of each other. Empty boxes are apart
 from all others; no box at all hangs together. */
[[nodiscard]] bool AreConnected(std::span<const Box> boxes, double margin, WorkWatch* watch);

}  // namespace hvas::spatial
