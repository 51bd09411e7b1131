#include "fits/actual_size.h"

#include <cmath>
#include <numbers>

#include "fits/size_distribution.h"

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
  return SizeDistribution::FromZone(limits).Quantile(random->Uniform());
}

}  // namespace hvas::fits
