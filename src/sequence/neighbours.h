#pragma once

#include <stop_token>
#include <vector>

#include "contact/scene.h"
#include "product/product.h"

namespace hvas::sequence {

/** Parts that hold each part in the assembled product, sorted; indexed by OccurrenceId. */
using Neighbours = std::vector<std::vector<product::OccurrenceId>>;

/** Finds for each part the parts that it has a mate with. @param absent  As of FindNeighbours(). */
[[nodiscard]] Neighbours FindMated(const product::Product& product,
                                   const std::vector<product::OccurrenceId>& absent);

/** Finds for each part the parts that it has a mate with, or touches as drawn to 0.1 mm.
 @param scene  All parts at their drawn poses; body index = occurrence index.
 @param absent  Parts that hold nothing and are not held. @param stop  Ends the search early. */
[[nodiscard]] Neighbours FindNeighbours(const product::Product& product,
                                        const contact::Scene& scene,
                                        const std::vector<product::OccurrenceId>& absent,
                                        const std::stop_token& stop);

/** Lists those of some parts whose removal would leave others, which are connected with them now,
 without a connection through neighbours: the cut vertices of their graph (Tarjan, SIAM J. Computing
 1(2), 1972), sorted. */
[[nodiscard]] std::vector<product::OccurrenceId> ListCutParts(
    const std::vector<product::OccurrenceId>& parts, const Neighbours& neighbours);

/** Lists those of some parts that are connected with one of them through neighbours among them,
 that one included; in the order of the parts given. */
[[nodiscard]] std::vector<product::OccurrenceId> ListConnected(
    product::OccurrenceId id, const std::vector<product::OccurrenceId>& parts,
    const Neighbours& neighbours);

/** Whether some parts are connected with each other through neighbours among them. */
[[nodiscard]] bool AreConnected(const std::vector<product::OccurrenceId>& parts,
                                const Neighbours& neighbours);

}  // namespace hvas::sequence
