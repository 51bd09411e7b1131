#include "fits/actual_size.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

// W2's example: a zone of 12 um has mean 6 and sigma 2, and 0.998846 of the normal distribution.
TEST(CalcSizeProbabilities, TwelveMicrometresAreTheNormalDistributionCutAtTheLimits) {
  const std::vector<double> probabilities = CalcSizeProbabilities(12);
  ASSERT_EQ(probabilities.size(), 13U);
  double inside = 0;
  double mean = 0;
  for (int k = 0; k <= 12; ++k) {
    // Simpson's rule over the micrometre, as a second way to the same figure.
    double integral = 0;
    constexpr int kSteps = 100;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = (k - 0.5 + static_cast<double>(i) / kSteps - 6) / 2.0;
      const double weight = i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2);
      integral += weight * std::exp(-0.5 * t * t) / (3.0 * kSteps);
    }
    integral /= 2 * std::sqrt(2 * std::numbers::pi);
    inside += integral;
    mean += k * probabilities[static_cast<std::size_t>(k)];
    EXPECT_NEAR(probabilities[static_cast<std::size_t>(k)] * 0.998846, integral, 5e-7);
  }
  EXPECT_NEAR(inside, 0.998846, 5e-7);
  EXPECT_NEAR(mean, 6, 1e-12);
}

TEST(CalcSizeProbabilities, SumToOneAreSymmetricAndPeakInTheMiddle) {
  for (int zone = 0; zone <= 200; ++zone) {
    const std::vector<double> p = CalcSizeProbabilities(zone);
    ASSERT_EQ(p.size(), static_cast<std::size_t>(zone + 1));
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
    for (std::size_t k = 0; k < p.size(); ++k) {
      EXPECT_NEAR(p[k], p[p.size() - 1 - k], 1e-15);
      EXPECT_LE(p[k], p[p.size() / 2] + 1e-15);
    }
  }
}

TEST(DrawDeviation, W2FrequenciesFollowTheProbabilities) {
  const Limits limits{units::FromUm(-25), units::FromUm(-9)};  // 40 g6
  const std::vector<double> probabilities = CalcSizeProbabilities(16);
  std::vector<int> counts(17, 0);
  Random random(7);
  constexpr int kDraws = 200000;
  for (int i = 0; i < kDraws; ++i) {
    const double deviation_um = units::ToUm(DrawDeviation(limits, &random));
    const double k = deviation_um + 25;
    ASSERT_NEAR(k, std::round(k), 1e-6);
    ASSERT_GE(k, -1e-6);
    ASSERT_LE(k, 16 + 1e-6);
    ++counts[static_cast<std::size_t>(std::lround(k))];
  }
  double chi2 = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double expected = kDraws * probabilities[k];
    chi2 += (counts[k] - expected) * (counts[k] - expected) / expected;
  }
  EXPECT_LT(chi2, 39.3);  // 16 degrees of freedom, p = 0.001.
}

TEST(DrawDeviation, SameSeedSameSizes) {
  const Limits limits{0, units::FromUm(25)};
  Random a(3);
  Random b(3);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(DrawDeviation(limits, &a), DrawDeviation(limits, &b));
  }
}

}  // namespace
}  // namespace hvas::fits
