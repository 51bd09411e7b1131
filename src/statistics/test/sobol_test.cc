// Sobol's indices against those of functions whose indices are known in closed form.

#include "statistics/sobol.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::statistics {
namespace {

using Point = std::array<double, 3>;  // Uniform inputs in [0, 1).

/** Ishigami and Homma, "An importance quantification technique in uncertainty analysis for computer
 models", ISUMA 1990: x_i uniform in [-pi, pi]. */
double Ishigami(const Point& u) {
  constexpr double kPi = std::numbers::pi;
  constexpr double kA = 7;    // The constants with which the function is usually tested.
  constexpr double kB = 0.1;  // Likewise.
  const auto x = [&u](std::size_t i) { return kPi * (2 * u[i] - 1); };
  return std::sin(x(0)) + kA * std::pow(std::sin(x(1)), 2) +
         kB * std::pow(x(2), 4) * std::sin(x(0));
}

SobolSample Evaluate(const std::function<double(const Point&)>& f, int rows) {
  SobolSample sample;
  sample.ab.resize(3);
  Random random(20);
  for (int j = 0; j < rows; ++j) {
    Point a{};
    Point b{};
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = random.Uniform();
      b[i] = random.Uniform();
    }
    sample.a.push_back(f(a));
    sample.b.push_back(f(b));
    for (std::size_t i = 0; i < 3; ++i) {
      Point mixed = a;
      mixed[i] = b[i];
      sample.ab[i].push_back(f(mixed));
    }
  }
  return sample;
}

TEST(Sobol, IndicesOfTheIshigamiFunctionAreTheAnalyticOnes) {
  // V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2 with a = 7, b = 0.1: S = 0.3139, 0.4424, 0 and
  // ST = 0.5576, 0.4424, 0.2437.
  const auto indices = CalcSobol(Evaluate(Ishigami, 65536), {100, 1, 0.95});
  ASSERT_TRUE(indices) << indices.error().ToString();
  constexpr std::array kFirst{0.3139, 0.4424, 0.0};
  constexpr std::array kTotal{0.5576, 0.4424, 0.2437};
  for (std::size_t i = 0; i < 3; ++i) {
    const SobolIndex& index = (*indices)[i];
    EXPECT_NEAR(index.first, kFirst[i], 0.015) << i;  // Three standard errors of so many rows.
    EXPECT_NEAR(index.total, kTotal[i], 0.015) << i;
    EXPECT_LT(index.first_ci.low, index.first);
    EXPECT_GT(index.first_ci.high, index.first);
    EXPECT_LT(index.total_ci.high - index.total_ci.low, 0.03);
  }
}

// An interval of nearly all ends at the least and the largest of a hundred resamples, of which none
// may be far from the index: the standard error of 16,384 rows is 0.01, five times that is not
// reached.
TEST(Sobol, EveryResampleIsNearTheIndex) {
  const auto indices = CalcSobol(Evaluate(Ishigami, 16384), {100, 1, 0.9999});
  ASSERT_TRUE(indices) << indices.error().ToString();
  for (const SobolIndex& index : *indices) {
    for (const auto& [ci, value] :
         {std::pair(index.first_ci, index.first), std::pair(index.total_ci, index.total)}) {
      EXPECT_NEAR(ci.low, value, 0.05);
      EXPECT_NEAR(ci.high, value, 0.05);
    }
  }
}

TEST(Sobol, AConstantHasNoIndices) {
  const auto indices = CalcSobol(Evaluate([](const Point&) { return 3.0; }, 100));
  ASSERT_TRUE(indices);
  EXPECT_EQ((*indices)[0].first, 0);
  EXPECT_EQ((*indices)[0].total, 0);
}

TEST(Sobol, ALargeMeanDoesNotChangeTheIndices) {
  const auto near = CalcSobol(Evaluate(Ishigami, 4096));
  const auto far = CalcSobol(Evaluate([](const Point& u) { return 1e6 + Ishigami(u); }, 4096));
  ASSERT_TRUE(near && far);
  EXPECT_NEAR((*near)[1].first, (*far)[1].first, 1e-6);
  EXPECT_NEAR((*near)[1].total, (*far)[1].total, 1e-6);
}

TEST(Sobol, RefusesSamplesOfDifferentSize) {
  SobolSample sample = Evaluate(Ishigami, 10);
  sample.b.pop_back();
  EXPECT_FALSE(CalcSobol(sample));
  EXPECT_FALSE(CalcSobol(Evaluate(Ishigami, 10), {5, 1, 0.95}));
}

}  // namespace
}  // namespace hvas::statistics
