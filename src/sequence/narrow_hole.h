#pragma once

#include <string>

#include "product/product.h"

namespace hvas::sequence {

/** Explains with both diameters that a shaft of one of two parts would have to pass a smaller hole
 of the other one along a direction in W. Empty where none is wider than its hole by `least` of
 radius [m], and where `other` is invalid. */
[[nodiscard]] std::string ExplainTooWide(const product::Product& product, product::OccurrenceId id,
                                         product::OccurrenceId other, const Vec3& direction,
                                         double least);

}  // namespace hvas::sequence
