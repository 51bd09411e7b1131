#pragma once

#include <vector>

#include "product/product.h"
#include "product/rings.h"

namespace hvas::product {

/** Holes, shafts and bosses with their lead-ins, and the grooves and chamfers in them. */
[[nodiscard]] std::vector<Form> FindRoundForms(const Part& part, const RingSet& set,
                                               const std::vector<RingChain>& chains,
                                               double tolerance);

}  // namespace hvas::product
