#include "mates/make_fit.h"

#include <utility>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::mates {

product::FitKind ToKind(fits::FitKind kind) {
  switch (kind) {
    case fits::FitKind::kClearance:
      return product::FitKind::kClearance;
    case fits::FitKind::kTransition:
      return product::FitKind::kTransition;
    case fits::FitKind::kInterference:
      break;
  }
  return product::FitKind::kInterference;
}

Result<product::Fit> MakeWholeFit(const fits::FitClass& fit, double nominal, std::string reason) {
  const Result<fits::FitLimits> limits = fits::CalcFitLimits(fit, nominal);
  if (!limits) {
    return Unexpected(limits.error());
  }
  return product::Fit{ToKind(limits->kind), fit.ToString(), nominal, false, std::move(reason)};
}

Result<void> CheckDrawnPress(const product::Mate& mate) {
  const double interference = 2 * (mate.shaft_radius - mate.hole_radius);
  const double largest = fits::CalcLargestPress(2 * mate.hole_radius);
  if (mate.kind != product::MateKind::kAxisHole || interference <= largest) {
    return {};
  }
  return Fail(
      ErrorCode::kInvalid,
      fmt::format("{:.6g} mm is drawn in a hole of {:.6g} mm, and no press fit of this size "
                  "has more than {:.3f} mm",
                  units::ToMm(2 * mate.shaft_radius), units::ToMm(2 * mate.hole_radius),
                  units::ToMm(largest)),
      mate.key, "correct the diameters in the CAD system, or assign \"thread\"");
}

}  // namespace hvas::mates
