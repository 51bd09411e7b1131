#pragma once

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::mates {

/** Fills product->joints from its mates: one for each pair of parts that has any, in the order of
 the pairs. The freedom left is the nullspace of the mates' Jacobian (`CalcFreeTwists`) in the drawn
 pose: an axis in a hole leaves one translation and one rotation, with a face on it the rotation
 only, two dowels and a face nothing. Contacts count as if they held in both directions. Ends early
 when the watch says so. */
void BuildJoints(product::Product* product, WorkWatch* watch = nullptr);

}  // namespace hvas::mates
