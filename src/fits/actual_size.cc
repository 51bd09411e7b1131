#include "fits/actual_size.h"

#include <cmath>
#include <numbers>

#include "base/units.h"

namespace hvas::fits {

std::vector<double> CalcSizeProbabilities(int zone_um) {
  if (zone_um <= 0) {
    return {1.0};
  }
  const double mean_um = 0.5 * zone_um;
  const double sigma_um = zone_um / 6.0;
  std::vector<double> probabilities;
  double sum = 0;
  for (int k = 0; k <= zone_um; ++k) {
    const double scale = std::numbers::sqrt2 * sigma_um;
    probabilities.push_back(
        0.5 * (std::erf((k + 0.5 - mean_um) / scale) - std::erf((k - 0.5 - mean_um) / scale)));
    sum += probabilities.back();
  }
  for (double& probability : probabilities) {
    probability /= sum;
  }
  return probabilities;
}

double DrawDeviation(const Limits& limits, Random* random) {
  // Zones are whole micrometres but for the finest grades, which lose a part of one here.
  const double zone_um = units::ToUm(limits.upper - limits.lower);
  const std::vector<double> probabilities =
      CalcSizeProbabilities(static_cast<int>(std::floor(zone_um + 1e-6)));
  double left = random->Uniform();
  std::size_t k = 0;
  while (k + 1 < probabilities.size() && left >= probabilities[k]) {
    left -= probabilities[k++];
  }
  return limits.lower + units::FromUm(static_cast<double>(k));
}

}  // namespace hvas::fits
