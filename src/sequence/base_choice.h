#pragma once

#include <vector>

#include "product/product.h"
#include "sequence/neighbours.h"

namespace hvas::sequence {

/** Volume, or that of the box of a part without one [m^3]. */
[[nodiscard]] double SizeOf(const product::Part& part);

/** Chooses the part that stays in the fixture: the largest, or what most is joined to, where the
 largest is joined to little.
 @param parts  At least one, the largest last.
 @param neighbours  Of all parts; those with other parts do not count. */
[[nodiscard]] product::OccurrenceId ChooseBase(const product::Product& product,
                                               const std::vector<product::OccurrenceId>& parts,
                                               const Neighbours& neighbours);

}  // namespace hvas::sequence
