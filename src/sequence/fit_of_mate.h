#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/diagnostics.h"
#include "base/result.h"
#include "fits/fit_force.h"
#include "fits/friction.h"
#include "fits/pair_choice.h"
#include "product/product.h"

namespace hvas::sequence {

/** What a part's surface is, by the standard material that its own was matched to. */
[[nodiscard]] fits::FrictionSurface SurfaceOf(const product::Material& material);

/** Code of the note about a fit whose kind no pair shows. */
inline constexpr const char* kFitNotShown = "fit-not-shown";

/** The kind of a fit, as the room `fits` calls it. @pre the fit is no thread. */
[[nodiscard]] fits::FitKind ToFitsKind(product::FitKind kind);

/** Seed of the stream that draws the sizes and the surface of a mate: every mate has its own, so
 that one mate's fit does not change another's sizes. */
[[nodiscard]] std::uint64_t CalcFitSeed(std::uint64_t seed, product::MateId mate);

/** The steepest chamfer that leads in with a coefficient of friction, as an angle to the axis
 [rad]; steeper ones count as this. */
[[nodiscard]] double CalcSteepestLeadIn(double friction) noexcept;

/** All that is known of the fit of a mate before its sizes are drawn. */
struct FitToDraw {
  fits::FitForceParameters parameters;  ///< Sizes and seed are missing where these are drawn.
  fits::PairToDraw pair;                ///< Its choice is kAny where sizes have no kind to show.
};

/** Collects what MakeFitForce draws and calculates from. None where the mate has no fit of ISO 286
 or neither a code nor a size is known. Errors: kInvalid where the code or the size is not defined
 by the standard. */
[[nodiscard]] Result<std::optional<FitToDraw>> MakeFitToDraw(const product::Product& product,
                                                             const product::Mate& mate,
                                                             fits::PairChoice pairs);

/** The fit of an axis-hole or prismatic mate as forces over depth, from Mate::fit and
 Mate::conditions. Widths of a prismatic mate count as diameters. Of each side:

 | | |
 |---|---|
 | diameter at 20 C | measured, or by seed, mate and choice of pairs from its class, or as drawn |
 | temperature T | times 1 + alpha (T - 20 C), alpha that of the part's material (free expansion) |
 | roughness Rz | stated, or the default; the pair has the mean of both |
 | elasticity | of the part's material |
 | walls | hub: its outside about the hole; shaft: its bore, where it has one; slot: what is behind
 its walls |

 Friction is the stated coefficient for everything, or else that of the pair of materials: static to
 press in, to break loose and to turn, kinetic to slip outwards. A chamfer at an end of the shaft,
 or else of the hole, leads in. Null for planes, for threads, where neither a code nor a size is
 known, and, with a diagnostic, where the code or the size is not defined by the standard.

 Where sizes or surface are drawn again (fits::PairChoice) and none of kMostPairsDrawn pairs shows
 the kind of the fit, the last one stays, with the note kFitNotShown. Nothing is drawn again where
 a temperature is stated, which changes the kind on purpose. */
[[nodiscard]] std::shared_ptr<const fits::FitForce> MakeFitForce(const product::Product& product,
                                                                 const product::Mate& mate,
                                                                 std::uint64_t seed,
                                                                 fits::PairChoice pairs,
                                                                 Diagnostics* diagnostics);

}  // namespace hvas::sequence
