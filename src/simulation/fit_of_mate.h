#pragma once

#include <cstdint>
#include <memory>

#include "base/diagnostics.h"
#include "fits/fit_force.h"
#include "product/product.h"

namespace hvas::simulation {

/** The fit of an axis-hole mate as forces over depth, from Mate::fit and Mate::conditions:

 | of each side | |
 |---|---|
 | diameter at 20 C | measured, or drawn by seed and mate from the zone of its class, or as drawn in
 the file | | temperature T | times 1 + alpha (T - 20 C), alpha that of the part's material (free
 expansion) | | roughness Rz | stated, or the default; the pair has the mean of both |

 Friction is the stated one or the default. Null for planes, for threads, where neither a code nor a
 size is known, and, with a diagnostic, where the code or the size is not defined by the standard.
 */
[[nodiscard]] std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                                 const product::Mate& mate,
                                                                 std::uint64_t seed,
                                                                 Diagnostics* diagnostics);

}  // namespace hvas::simulation
