#pragma once

#include <cstdint>
#include <memory>

#include "base/diagnostics.h"
#include "fits/fit_force.h"
#include "product/product.h"

namespace hvas::simulation {

/** The fit of an axis-hole mate as forces over depth: actual sizes drawn by seed and mate from the
 zones of its ISO 286 code, roughness and friction by default. Null for planes, for threads, and,
 with a diagnostic, where the code or the size is not defined by the standard. */
[[nodiscard]] std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                                 const product::Mate& mate,
                                                                 std::uint64_t seed,
                                                                 Diagnostics* diagnostics);

}  // namespace hvas::simulation
