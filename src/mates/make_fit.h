#pragma once

#include <string>

#include "base/result.h"
#include "fits/iso286.h"
#include "product/mate.h"

namespace hvas::mates {

[[nodiscard]] product::FitKind ToKind(fits::FitKind kind);

/** The fit that a class ("H7/p6") makes of a diameter. @param nominal  Diameter [m].
 Errors: those of fits::CalcFitLimits. */
[[nodiscard]] Result<product::Fit> MakeWholeFit(const fits::FitClass& fit, double nominal,
                                                std::string reason);

/** Checks that ISO 286 has a fit with the interference that the parts of a mate are drawn with, so
 that one can be stated for it. Error: kInvalid with both diameters. */
[[nodiscard]] Result<void> CheckDrawnPress(const product::Mate& mate);

}  // namespace hvas::mates
