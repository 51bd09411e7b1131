#include "haptics/force_map.h"

#include <cmath>

namespace hvas::haptics {

ForceMap::ForceMap(double largest_true, double largest_felt) {
  if (!(largest_felt > 0)) {
    return;
  }
  // Solve L (1 + ln(T/L)) = f for L in (0, f]: the left side rises with L up to L = T.
  double low = 0;
  double high = largest_felt;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (middle * (1 + std::log(largest_true / middle)) < largest_felt ? low : high) = middle;
  }
  linear_limit_ = 0.5 * (low + high);
}

double ForceMap::Felt(double true_magnitude) const noexcept {
  if (linear_limit_ <= 0) {
    return 0;
  }
  return true_magnitude <= linear_limit_
             ? true_magnitude
             : linear_limit_ * (1 + std::log(true_magnitude / linear_limit_));
}

double ForceMap::True(double felt_magnitude) const noexcept {
  return felt_magnitude <= linear_limit_ || linear_limit_ <= 0
             ? felt_magnitude
             : linear_limit_ * std::exp(felt_magnitude / linear_limit_ - 1);
}

}  // namespace hvas::haptics
