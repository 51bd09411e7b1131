#include "fits/paper_scales.h"

#include <cmath>

namespace hvas::fits {
namespace {

constexpr PaperScale kClearanceScale{FitKind::kClearance, "H7/g6", "", 0.3, 0.3, 1};
constexpr PaperScale kTransitionScale{FitKind::kTransition, "H7/k6", "k_s", 4, 2329, 4.0 / 2329};
constexpr PaperScale kInterferenceScale{FitKind::kInterference, "H7/p6", "k_r", 6, 39893.3,
                                        6.0 / 39893.3};

}  // namespace

const PaperScale& FindPaperScale(FitKind kind) noexcept {
  switch (kind) {
    case FitKind::kTransition:
      return kTransitionScale;
    case FitKind::kInterference:
      return kInterferenceScale;
    case FitKind::kClearance:
      break;
  }
  return kClearanceScale;
}

double CalcPaperFactor(FitKind kind, double true_force) noexcept {
  const PaperScale& scale = FindPaperScale(kind);
  const bool is_scaled = kind != FitKind::kClearance && true_force > 0 && std::isfinite(true_force);
  return is_scaled ? scale.largest_shown / true_force : scale.factor;
}

}  // namespace hvas::fits
