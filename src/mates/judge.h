#pragma once

#include "mates/limits.h"
#include "mates/propose_fit.h"
#include "product/product.h"

namespace hvas::mates {

/** Fills `evidence` and `confidence` of an inferred mate by the rule of docs/algorithms/mates.md: a
 product of how close the sizes are, how much of them is engaged, how exactly they are placed, and
 whether the names agree. @param part_a, part_b  What the names and shapes of the parts say. */
void Judge(const product::Product& product, const InferenceLimits& limits, FastenerKind part_a,
           FastenerKind part_b, product::Mate* mate);

/** How far the shaft's axis, or the ball's centre, is from the frame's origin, which is the hole's,
 the seat's or the socket's: how far off they are drawn [m]. */
[[nodiscard]] double CalcOffset(const product::Product& product, const product::Mate& mate);

/** Evidence alone, in a few words with numbers: "radii 3.000/2.990 mm, engaged 12.00 mm, axes 0.00
 um apart". */
[[nodiscard]] std::string DescribeEvidence(const product::Product& product,
                                           const product::Mate& mate);

}  // namespace hvas::mates
