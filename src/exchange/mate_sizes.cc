#include "exchange/mate_sizes.h"

#include <vector>

#include "fits/iso286.h"

namespace hvas::exchange {
namespace {

std::optional<double> MeanOf(const std::vector<product::MeasuredDiameter>& measured) {
  if (measured.empty()) {
    return std::nullopt;
  }
  double sum = 0;
  for (const product::MeasuredDiameter& place : measured) {
    sum += place.diameter;
  }
  return sum / static_cast<double>(measured.size());
}

}  // namespace

std::optional<MateSizes> CalcMateSizes(const product::Mate& mate) {
  if (!mate.fit || mate.fit->kind == product::FitKind::kThread) {
    return std::nullopt;
  }
  MateSizes sizes{2 * mate.hole_radius, 2 * mate.shaft_radius, 0, 0};
  sizes.min_clearance = sizes.clearance();
  sizes.max_clearance = sizes.clearance();
  const double nominal = mate.fit->nominal_diameter;
  if (const auto fit = fits::ParseFit(mate.fit->code); fit && nominal > 0) {
    if (const auto limits = fits::CalcFitLimits(*fit, nominal)) {
      sizes = {nominal + 0.5 * (limits->hole.lower + limits->hole.upper),
               nominal + 0.5 * (limits->shaft.lower + limits->shaft.upper), limits->min_clearance,
               limits->max_clearance};
    }
  }
  const auto hole = MeanOf(mate.conditions.hole_diameters);
  const auto shaft = MeanOf(mate.conditions.shaft_diameters);
  sizes.hole = hole.value_or(sizes.hole);
  sizes.shaft = shaft.value_or(sizes.shaft);
  if (hole && shaft) {
    sizes.min_clearance = sizes.clearance();
    sizes.max_clearance = sizes.clearance();
  }
  return sizes;
}

}  // namespace hvas::exchange
