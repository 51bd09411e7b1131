#include "statistics/shares.h"

#include <cmath>

#include <gtest/gtest.h>

#include "statistics/distributions.h"

namespace hvas::statistics {
namespace {

TEST(Share, HasTheIntervalOfClopperAndPearson) {
  const auto share = CalcShare(205, 225);  // Paper W, table 2, B1. R 4.2.2: binom.test(205, 225).
  ASSERT_TRUE(share);
  EXPECT_NEAR(share->ci.low, 0.866057412955, 1e-11);
  EXPECT_NEAR(share->ci.high, 0.944857345112, 1e-11);
  const auto nine = CalcShare(9, 15, 1.0 / 3);
  EXPECT_NEAR(nine->ci.low, 0.322869766206, 1e-11);
  EXPECT_NEAR(nine->ci.high, 0.83663567614, 1e-11);
  EXPECT_NEAR(*nine->chance_p, 0.0308279229909, 1e-12);
}

TEST(Share, IntervalEndsWhereTheTailsAreHalfOfWhatIsLeft) {
  for (int right = 1; right < 15; ++right) {
    const auto share = CalcShare(right, 15, {}, 0.9);
    EXPECT_NEAR(CalcBinomialUpper(right, 15, share->ci.low), 0.05, 1e-12) << right;
    EXPECT_NEAR(CalcBinomialLower(right, 15, share->ci.high), 0.05, 1e-12) << right;
  }
}

// None of n: the upper end solves (1 - p)^n = 0.025.
TEST(Share, OfNoneAndAllIsKnownInClosedForm) {
  const auto none = CalcShare(0, 20, 0.5);
  EXPECT_EQ(none->ci.low, 0);
  EXPECT_NEAR(none->ci.high, 1 - std::pow(0.025, 1.0 / 20), 1e-14);
  EXPECT_EQ(*none->chance_p, 1);
  const auto all = CalcShare(20, 20, 0.5);
  EXPECT_EQ(all->ci.high, 1);
  EXPECT_NEAR(*all->chance_p, std::pow(0.5, 20), 1e-20);
}

TEST(Share, RefusesWhatCannotBeCounted) {
  EXPECT_FALSE(CalcShare(0, 0));
  EXPECT_FALSE(CalcShare(-1, 5));
  EXPECT_FALSE(CalcShare(6, 5));
  EXPECT_FALSE(CalcShare(1, 5, 0.0));
  EXPECT_FALSE(CalcShare(1, 5, 1.0));
  EXPECT_FALSE(CalcShare(1, 5, {}, 2.0));
}

// By hand: of 50, 20 + 15 agree (0.7); margins give 0.5 * 0.6 + 0.5 * 0.4 = 0.5, so kappa 0.4.
TEST(Confusion, HasTheKappaOfAHandCalculation) {
  const auto confusion = CalcConfusion({{20, 5}, {10, 15}});
  ASSERT_TRUE(confusion);
  EXPECT_DOUBLE_EQ(confusion->accuracy.share, 0.7);
  EXPECT_NEAR(*confusion->kappa, 0.4, 1e-14);
  EXPECT_DOUBLE_EQ(confusion->recall[0]->share, 0.8);
  EXPECT_DOUBLE_EQ(confusion->recall[1]->share, 0.6);
}

TEST(Confusion, KappaIsOneOfAgreementAndZeroOfIndependence) {
  EXPECT_DOUBLE_EQ(*CalcConfusion({{3, 0, 0}, {0, 4, 0}, {0, 0, 5}})->kappa, 1);
  EXPECT_NEAR(*CalcConfusion({{6, 3}, {4, 2}})->kappa, 0, 1e-14);
}

TEST(Confusion, SaysWhatIsNotDefined) {
  EXPECT_FALSE(CalcConfusion({{7, 0}, {0, 0}})->kappa) << "one thing, one answer";
  EXPECT_FALSE(CalcConfusion({{7, 1}, {0, 0}})->recall[1]) << "never shown";
  EXPECT_FALSE(CalcConfusion({{0, 0}, {0, 0}}));
  EXPECT_FALSE(CalcConfusion({}));
  EXPECT_FALSE(CalcConfusion({{1, 2}}));
  EXPECT_FALSE(CalcConfusion({{1, -2}, {1, 1}}));
}

}  // namespace
}  // namespace hvas::statistics
