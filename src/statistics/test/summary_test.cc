#include "statistics/summary.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "statistics/paired.h"

namespace hvas::statistics {
namespace {

// By hand: mean 5, squares 9+1+1+1+0+0+4+16 = 32, so sd = sqrt(32/7); t(7, 0.975) = 2.364624 of
// every printed table.
TEST(Summary, HasTheFiguresOfAHandCalculation) {
  const std::vector<double> values{2, 4, 4, 4, 5, 5, 7, 9};
  const auto summary = Summarise(values);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->n, 8u);
  EXPECT_DOUBLE_EQ(summary->mean, 5);
  ASSERT_TRUE(summary->sd);
  EXPECT_NEAR(*summary->sd, std::sqrt(32.0 / 7), 1e-14);
  EXPECT_NEAR(summary->mean_ci->high - 5, 2.364624 * std::sqrt(32.0 / 7 / 8), 1e-6);
  EXPECT_NEAR(summary->mean_ci->high + summary->mean_ci->low, 10, 1e-12);
  EXPECT_DOUBLE_EQ(summary->median, 4.5);
  EXPECT_DOUBLE_EQ(summary->lower_quartile, 4);
  EXPECT_DOUBLE_EQ(summary->upper_quartile, 5.5);  // Type 7: a quarter of the way from 5 to 7.
  EXPECT_DOUBLE_EQ(summary->min, 2);
  EXPECT_DOUBLE_EQ(summary->max, 9);
}

TEST(Summary, OfOneValueHasNoSpread) {
  const auto summary = Summarise(std::vector<double>{3});
  ASSERT_TRUE(summary);
  EXPECT_DOUBLE_EQ(summary->median, 3);
  EXPECT_DOUBLE_EQ(summary->upper_quartile, 3);
  EXPECT_FALSE(summary->sd);
  EXPECT_FALSE(summary->mean_ci);
}

TEST(Summary, OfEqualValuesHasASpreadOfZeroInSpiteOfRounding) {
  const auto summary = Summarise(std::vector<double>(7, 0.1));
  ASSERT_TRUE(summary);
  EXPECT_EQ(*summary->sd, 0);
  EXPECT_EQ(summary->mean_ci->low, summary->mean_ci->high);
}

TEST(Summary, RefusesWhatIsNoSample) {
  EXPECT_FALSE(Summarise(std::vector<double>{}));
  const auto bad = Summarise(std::vector<double>{1, std::nan(""), 3});
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().message.find("value 2"), std::string::npos);
  EXPECT_FALSE(Summarise(std::vector<double>{1, std::numeric_limits<double>::infinity()}));
  for (const double confidence : {0.0, 1.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(Summarise(std::vector<double>{1, 2}, confidence)) << confidence;
  }
}

// Paper X: condition 3 took 9.4 s, 25.4 % less than 12.6 s and 68.5 % less than 29.8 s.
TEST(PairedDifference, IsToldInPerCentAsPaperXDoes) {
  const std::vector<double> one{28.8, 30.8};
  const std::vector<double> two{12.5, 12.7};
  const std::vector<double> three{9.3, 9.5};
  EXPECT_NEAR(*ComparePairs(two, three)->percent, -25.4, 0.05);
  EXPECT_NEAR(*ComparePairs(one, three)->percent, -68.5, 0.05);
}

TEST(PairedDifference, HasNoPerCentOfNothing) {
  EXPECT_FALSE(ComparePairs(std::vector<double>{-1, 1}, std::vector<double>{1, 2})->percent);
}

TEST(PairedDifference, NeedsPairs) {
  EXPECT_FALSE(ComparePairs(std::vector<double>{1, 2}, std::vector<double>{1}));
}

// Cumming and Finch, Educ. Psychol. Meas. 61, 2001: the interval holds where the observed t is at
// the 97.5 and 2.5 per cent points.
TEST(StandardizedDifference, PutsTheObservedTAtTheEndsOfItsDistributions) {
  std::vector<double> differences{-1, -0.6, -0.2, 0.1, 0.3, 0.5, 0.8, 1.2, 1.7, 2.2};
  const auto result = CalcStandardizedDifference(differences);
  ASSERT_TRUE(result);
  ASSERT_TRUE(*result);
  // R 4.2.2: uniroot(function(k) pt(d * sqrt(10), 9, k) - 0.975, ...)$root / sqrt(10).
  EXPECT_NEAR((*result)->d_z, 0.498341620638822, 1e-14);
  EXPECT_NEAR((*result)->ci.low, -0.173647425016, 1e-7);
  EXPECT_NEAR((*result)->ci.high, 1.146347900788, 1e-7);
  for (double& difference : differences) {
    difference = -difference;
  }
  const auto mirrored = CalcStandardizedDifference(differences);
  EXPECT_NEAR((*mirrored)->ci.low, -(*result)->ci.high, 1e-9);
}

TEST(StandardizedDifference, IsFiniteForHugeEffectsAndNoneForEqualDifferences) {
  const auto huge = CalcStandardizedDifference(std::vector<double>{1000, 1001, 1002, 1001});
  ASSERT_TRUE(huge);
  ASSERT_TRUE(*huge);
  EXPECT_TRUE(std::isfinite((*huge)->ci.low) && std::isfinite((*huge)->ci.high));
  EXPECT_LT((*huge)->ci.low, (*huge)->d_z);
  EXPECT_GT((*huge)->ci.high, (*huge)->d_z);
  EXPECT_FALSE(*CalcStandardizedDifference(std::vector<double>{2, 2, 2}));
  EXPECT_FALSE(*CalcStandardizedDifference(std::vector<double>{2}));
}

}  // namespace
}  // namespace hvas::statistics
