#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "paths/way.h"
#include "product/product.h"

namespace hvas::sequence {

/** Two parts that come apart along a screw which their faces leave them: a thread with modelled
 flanks, or a twisted bar in its hole, that no mate describes. */
struct ScrewPair {
  product::OccurrenceId hole;
  product::OccurrenceId shaft;
  paths::ScrewAxis axis;                    ///< Axis in W, as drawn.
  double turn{0};                           ///< Turn until they are apart [rad].
  double core_radius{0}, outer_radius{0};   ///< Least of the hole, largest of the shaft [m].
  std::vector<product::FaceId> hole_faces;  ///< Sorted.
  std::vector<product::FaceId> shaft_faces;
};

/** Judges a way that was found along a free motion. None where it is no screw of two parts over the
 whole length in which they engage, as the turn of a bayonet is none.
 @param part  The part that goes the way. @param bodies  Occurrences have the numbers of bodies. */
[[nodiscard]] std::optional<ScrewPair> FindScrewPair(product::OccurrenceId part,
                                                     const paths::FreeScrew& screw);

/** The product with a mate for each pair, as a thread that is drawn with its flanks: the part goes
 along the axis, led by the mate, and the flanks, which the way was checked against, are left out of
 contact then. Pairs with a thread already have its faces and sizes. @returns null where none is
 added. */
[[nodiscard]] std::shared_ptr<const product::Product> AddScrewMates(
    const product::Product& product, const std::vector<ScrewPair>& pairs);

}  // namespace hvas::sequence
