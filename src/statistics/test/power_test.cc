#include "statistics/power.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "statistics/distributions.h"

namespace hvas::statistics {
namespace {

/** Power of the paired t test of n normal differences with mean d and deviation 1, both sides. */
double CalcPowerOfT(double n, double d, double alpha) {
  const double t = CalcStudentQuantile(1 - 0.5 * alpha, n - 1);
  const double shift = d * std::sqrt(n);
  return 1 - CalcNonCentralStudent(t, n - 1, shift) + CalcNonCentralStudent(-t, n - 1, shift);
}

PowerOptions MakeOptions(PowerTest test, int runs) {
  PowerOptions options;
  options.test = test;
  options.runs = runs;
  options.seed = 20260401;
  return options;
}

// With correlation 0.5 the difference of two conditions has the deviation of one. Of normal
// differences Wilcoxon's test needs pi / 3 as many as the t test (Pitman's efficiency 3 / pi).
TEST(Power, OfWilcoxonIsThatOfTheTTestWithThreeOverPiAsMany) {
  const PowerOptions options = MakeOptions(PowerTest::kWilcoxon, 3000);
  for (const double d : {0.3, 0.5, 0.7}) {
    for (const int n : {20, 40, 80}) {
      const auto point = EstimatePower(NormalDesign{{0, d}, {1, 1}, 0.5}, options, n);
      ASSERT_TRUE(point);
      const double expected = CalcPowerOfT(n * 3 / std::numbers::pi, d, options.alpha);
      // The efficiency holds in the limit: 0.015, and three Monte Carlo errors.
      EXPECT_NEAR(point->power.share, expected, 0.015 + 3 * point->monte_carlo_error)
          << n << " participants, d " << d;
    }
  }
}

// Of two conditions Friedman's test is the sign test: (S+ - S-)^2 / n against chi-square, where S+
// is binomial with P(difference > 0) = Phi(d).
TEST(Power, OfFriedmanOnTwoConditionsIsThatOfTheSignTest) {
  const PowerOptions options = MakeOptions(PowerTest::kFriedman, 4000);
  for (const int n : {10, 25, 50}) {
    for (const double d : {0.0, 0.4, 0.8}) {
      double expected = 0;
      for (int up = 0; up <= n; ++up) {
        const double apart = 2.0 * up - n;
        if (CalcChiSquareUpper(apart * apart / n, 1) <= options.alpha) {
          const double p = CalcNormalUpper(-d);
          expected += CalcBinomialUpper(up, n, p) - (up < n ? CalcBinomialUpper(up + 1, n, p) : 0);
        }
      }
      const auto point = EstimatePower(NormalDesign{{0, d}, {1, 1}, 0.5}, options, n);
      ASSERT_TRUE(point);
      EXPECT_NEAR(point->power.share, expected,
                  3.5 * std::sqrt(expected * (1 - expected) / options.runs))
          << n << " participants, d " << d;
    }
  }
}

TEST(Power, WithoutADifferenceIsTheLevel) {
  for (const PowerTest test : {PowerTest::kFriedman, PowerTest::kWilcoxon}) {
    const std::size_t k = test == PowerTest::kFriedman ? 3 : 2;
    const PowerOptions options = MakeOptions(test, 4000);
    const auto point = EstimatePower(
        LogNormalDesign{std::vector<double>(k, 9.0), std::vector<double>(k, 0.3), 0.5}, options,
        40);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->power.share, options.alpha, 0.005 + 3 * point->monte_carlo_error);
  }
}

TEST(Power, SampleSizeIsTheLeastThatReachesTheTargetAndTheSameEveryTime) {
  const PowerOptions options = MakeOptions(PowerTest::kWilcoxon, 2000);
  const NormalDesign design{{0, 0.6}, {1, 1}, 0.5};
  const auto found = FindSampleSize(design, options);
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->participants);
  EXPECT_GE(EstimatePower(design, options, *found->participants)->power.share, 0.8);
  EXPECT_LT(EstimatePower(design, options, *found->participants - 1)->power.share, 0.8);
  // t test: 24 for d = 0.6, so about 24 * pi / 3.
  EXPECT_NEAR(*found->participants, 25, 2);
  const auto again = FindSampleSize(design, options);
  EXPECT_EQ(again->participants, found->participants);
  ASSERT_EQ(again->points.size(), found->points.size());
  for (std::size_t i = 0; i < found->points.size(); ++i) {
    EXPECT_EQ(again->points[i].power.right, found->points[i].power.right);
  }
}

// Paper W's shares: fifteen participants found the difference of three fits with p = 0.013.
TEST(Power, OfPaperWsIdentificationWasEnoughWithFifteen) {
  const PowerOptions options = MakeOptions(PowerTest::kFriedman, 2000);
  const CountDesign design{{205.0 / 225, 181.0 / 225, 174.0 / 225}, 15};
  const auto found = FindSampleSize(design, options);
  ASSERT_TRUE(found && found->participants);
  EXPECT_LE(*found->participants, 15);
  EXPECT_GE(*found->participants, 8);
}

TEST(Power, OfAPilotIsThatOfItsRows) {
  const PowerOptions options = MakeOptions(PowerTest::kWilcoxon, 500);
  // Everybody gains as much: from six on (p = 2 / 64 by sign, less by the normal approximation)
  // every study finds it.
  const auto certain = EstimatePower(PilotDesign{{{1, 2}, {3, 5}, {4, 4.5}}}, options, 8);
  EXPECT_EQ(certain->power.share, 1);
  const auto never = EstimatePower(PilotDesign{{{1, 1}, {2, 2}}}, options, 20);
  EXPECT_EQ(never->power.share, 0);
  PowerOptions few = options;
  few.most = 40;
  EXPECT_FALSE(FindSampleSize(PilotDesign{{{1, 1}, {2, 2}}}, few)->participants);
}

TEST(Power, RefusesDesignsThatCannotBe) {
  const PowerOptions options = MakeOptions(PowerTest::kFriedman, 100);
  const auto refused = [&](const Design& design) { return !EstimatePower(design, options, 10); };
  EXPECT_TRUE(refused(NormalDesign{{1}, {1}, 0.5}));
  EXPECT_TRUE(refused(NormalDesign{{1, 2}, {1}, 0.5}));
  EXPECT_TRUE(refused(NormalDesign{{1, 2}, {1, 0}, 0.5}));
  EXPECT_TRUE(refused(NormalDesign{{1, std::nan("")}, {1, 1}, 0.5}));
  EXPECT_TRUE(refused(NormalDesign{{1, 2}, {1, 1}, 1}));
  EXPECT_TRUE(refused(LogNormalDesign{{1, 0}, {1, 1}, 0.5}));
  EXPECT_TRUE(refused(CountDesign{{0.5, 1.5}, 15}));
  EXPECT_TRUE(refused(CountDesign{{0.5, 0.6}, 0}));
  EXPECT_TRUE(refused(PilotDesign{{{1, 2}}}));
  EXPECT_TRUE(refused(PilotDesign{{{1, 2}, {1}}}));
  PowerOptions wilcoxon = options;
  wilcoxon.test = PowerTest::kWilcoxon;
  EXPECT_FALSE(EstimatePower(CountDesign{{0.5, 0.6, 0.7}, 15}, wilcoxon, 10));
  EXPECT_FALSE(EstimatePower(CountDesign{{0.5, 0.6}, 15}, options, 2));
}

TEST(Power, RefusesOptionsFromTheirBoundsOn) {
  const NormalDesign design{{0, 1}, {1, 1}, 0.5};
  const auto is_refused = [&](auto change) {
    PowerOptions options = MakeOptions(PowerTest::kWilcoxon, 100);
    options.most = 20;
    change(&options);
    return !EstimatePower(design, options, 10);
  };
  EXPECT_FALSE(is_refused([](PowerOptions*) {}));
  for (const double alpha : {0.0, 0.5, std::nan("")}) {
    EXPECT_TRUE(is_refused([&](PowerOptions* o) { o->alpha = alpha; })) << alpha;
  }
  for (const double target : {0.0, 1.0, std::nan("")}) {
    EXPECT_TRUE(is_refused([&](PowerOptions* o) { o->target = target; })) << target;
  }
  for (const int runs : {99, 1'000'001}) {
    EXPECT_TRUE(is_refused([&](PowerOptions* o) { o->runs = runs; })) << runs;
  }
  for (const int most : {0, 9, 10'001}) {
    EXPECT_TRUE(is_refused([&](PowerOptions* o) { o->most = most; })) << most;
  }
  EXPECT_FALSE(is_refused([](PowerOptions* o) { o->most = 10; }));
}

TEST(Power, ProgressRisesFromNothingThroughEachTenthOfTheRuns) {
  std::vector<double> shares;
  const PowerOptions options = MakeOptions(PowerTest::kWilcoxon, 1000);
  const auto point = EstimatePower(NormalDesign{{0, 1}, {1, 1}, 0.5}, options, 10,
                                   [&](int participants, double share) {
                                     EXPECT_EQ(participants, 10);
                                     shares.push_back(share);
                                   });
  ASSERT_TRUE(point);
  ASSERT_GE(shares.size(), 10U);
  EXPECT_LT(shares.size(), 500U) << "a report of each run is too many";
  EXPECT_EQ(shares.front(), 0);
  for (std::size_t i = 1; i < shares.size(); ++i) {
    EXPECT_GT(shares[i], shares[i - 1]);
    EXPECT_LE(shares[i] - shares[i - 1], 0.1);
  }
  EXPECT_LT(shares.back(), 1);
  EXPECT_GE(shares.back(), 0.9);
}

}  // namespace
}  // namespace hvas::statistics
