#pragma once

#include <cstdint>
#include <memory>

#include "base/diagnostics.h"
#include "fits/fit_force.h"
#include "fits/friction.h"
#include "product/product.h"

namespace hvas::simulation {

/** What a part's surface is, by the standard material that its own was matched to. */
[[nodiscard]] fits::FrictionSurface SurfaceOf(const product::Material& material);

/** The fit of an axis-hole mate as forces over depth, from Mate::fit and Mate::conditions. Of each
 side:

 | | |
 |---|---|
 | diameter at 20 C | measured, or drawn by seed and mate from the zone of its class, or as drawn |
 | temperature T | times 1 + alpha (T - 20 C), alpha that of the part's material (free expansion) |
 | roughness Rz | stated, or the default; the pair has the mean of both |
 | elasticity | of the part's material |
 | walls | hub: its outside about the hole; shaft: its bore, where it has one |

 Friction is the stated coefficient for everything, or else that of the pair of materials: static to
 press in, to break loose and to turn, kinetic to slip outwards. A chamfer at an end of the shaft,
 or else of the hole, leads in. Null for planes, for threads, where neither a code nor a size is
 known, and, with a diagnostic, where the code or the size is not defined by the standard. */
[[nodiscard]] std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                                 const product::Mate& mate,
                                                                 std::uint64_t seed,
                                                                 Diagnostics* diagnostics);

}  // namespace hvas::simulation
