#include "haptics/thermal_limit.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {

ThermalLimit::ThermalLimit(double peak, double continuous, double time) noexcept
    : peak_(peak), continuous_(continuous), time_(time) {}

double ThermalLimit::limit() const noexcept {
  if (!is_limited()) {
    return peak_;
  }
  const double square = continuous_ * continuous_;
  const double left = std::max(0.0, 1 - mean_square_ / square);
  return std::sqrt(square + (peak_ * peak_ - square) * left);
}

void ThermalLimit::Heat(double force, double dt) noexcept {
  // The first-order lag's exact answer to a force held for dt.
  mean_square_ += (force * force - mean_square_) * -std::expm1(-dt / time_);
}

double ThermalLimit::rms() const noexcept {
  return std::sqrt(mean_square_);
}

}  // namespace hvas::haptics
