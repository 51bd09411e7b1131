#include "mates/make_fit.h"

#include <utility>

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

}  // namespace hvas::mates
