#include "statistics/rank_tests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "statistics/samples.h"

namespace hvas::statistics {
namespace {

// Right answers of 15 participants among 15 trials of each of three fits: paper W, table 2.
constexpr std::array<std::array<double, 3>, 15> kPaperCounts{{{14, 11, 13},
                                                              {12, 14, 9},
                                                              {12, 13, 13},
                                                              {15, 12, 12},
                                                              {14, 13, 9},
                                                              {15, 14, 12},
                                                              {12, 9, 13},
                                                              {14, 10, 13},
                                                              {15, 13, 10},
                                                              {14, 10, 13},
                                                              {14, 11, 12},
                                                              {14, 14, 10},
                                                              {12, 10, 14},
                                                              {15, 14, 10},
                                                              {13, 13, 11}}};

std::vector<double> PaperColumn(std::size_t column) {
  std::vector<double> values;
  for (const auto& row : kPaperCounts) {
    values.push_back(row[column]);
  }
  return values;
}

TEST(Friedman, GivesThePublishedPOfPaperW) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : kPaperCounts) {
    rows.emplace_back(row.begin(), row.end());
  }
  const auto result = TestFriedman(rows);
  ASSERT_TRUE(result);
  EXPECT_NEAR(*result->chi_square, 8.7143, 5e-5);
  EXPECT_NEAR(*result->p, 0.0128149, 5e-8);
  EXPECT_NEAR(*result->exact_p, 0.0109036, 5e-8);
  EXPECT_NEAR(*result->kendall_w, 8.7142857142857 / 30, 1e-12);
}

TEST(Wilcoxon, GivesThePublishedPsOfPaperW) {
  const std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  const std::array<double, 3> asymptotic{0.0091679, 0.0072138, 0.5030733};
  const std::array<double, 3> exact{0.00732, 0.00598, 0.55371};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto result = TestWilcoxon(PaperColumn(pairs[i][0]), PaperColumn(pairs[i][1]));
    ASSERT_TRUE(result);
    EXPECT_NEAR(*result->p, asymptotic[i], 5e-8) << i;
    EXPECT_NEAR(*result->exact_p, exact[i], 5e-6) << i;
    EXPECT_EQ(result->n + result->zero_count, 15u);
  }
}

/** Pratt's test by its definition: mid ranks of all |d|, zeros too, then the moments of the sum of
 signed ranks of what is not zero. */
double CalcPrattZ(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double difference : differences) {
    sizes.push_back(std::abs(difference));
  }
  const std::vector<double> ranks = CalcMidRanks(sizes).ranks;
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (differences[i] != 0) {
      sum += differences[i] > 0 ? ranks[i] : -ranks[i];
      squares += ranks[i] * ranks[i];
    }
  }
  return sum / std::sqrt(squares);  // Fair signs have mean 0 and the squares as variance.
}

TEST(Friedman, ImanAndDavenportsFIsKnownOfPaperWsTable) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : kPaperCounts) {
    rows.emplace_back(row.begin(), row.end());
  }
  const auto result = TestFriedman(rows);
  ASSERT_TRUE(result);
  EXPECT_NEAR(*result->iman_davenport_f, 5.7315, 5e-5);
  EXPECT_NEAR(*result->iman_davenport_p, 0.008195, 5e-7);
  // Full agreement leaves nothing to divide by.
  const auto agreed = TestFriedman(std::vector<std::vector<double>>(5, {1, 2, 3}));
  EXPECT_FALSE(agreed->iman_davenport_f);
  EXPECT_FALSE(agreed->iman_davenport_p);
}

TEST(Wilcoxon, VariantsAreKnownOfPaperWsTable) {
  const std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  const std::array<double, 3> continuity{0.01015, 0.00786, 0.52581};
  const std::array<double, 3> pratt{0.00851, 0.00721, 0.54785};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto result = TestWilcoxon(PaperColumn(pairs[i][0]), PaperColumn(pairs[i][1]));
    ASSERT_TRUE(result);
    EXPECT_NEAR(*result->continuity_p, continuity[i], 5e-6) << i;
    EXPECT_NEAR(*result->pratt_p, pratt[i], 5e-6) << i;
  }
}

TEST(Wilcoxon, PrattsZIsThatOfItsDefinition) {
  Random random(20260303);
  int with_zeros = 0;
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw);
    const auto n = static_cast<std::size_t>(random.Uniform(2, 40));
    std::vector<double> first(n);
    std::vector<double> second(n);
    for (std::size_t i = 0; i < n; ++i) {
      first[i] = std::floor(random.Uniform(0, 9));
      second[i] = std::floor(random.Uniform(0, 10));
    }
    const auto result = TestWilcoxon(first, second);
    ASSERT_TRUE(result);
    if (result->n == 0) {
      EXPECT_FALSE(result->pratt_z);
      EXPECT_FALSE(result->continuity_p);
      continue;
    }
    EXPECT_NEAR(*result->pratt_z, CalcPrattZ(*CalcDifferences(first, second)), 1e-12);
    EXPECT_GE(*result->continuity_p, *result->p);
    with_zeros += result->zero_count > 0 ? 1 : 0;
    if (result->zero_count == 0) {
      EXPECT_NEAR(*result->pratt_p, *result->p, 1e-12);
    }
  }
  EXPECT_GT(with_zeros, 100);
}

TEST(MidRanks, ShareRanksAmongTies) {
  const MidRanks mid = CalcMidRanks(std::vector<double>{5, 1, 5, 3, 5});
  EXPECT_EQ(mid.ranks, (std::vector<double>{4, 1, 4, 2, 4}));
  EXPECT_EQ(mid.tie_sum, 24);
}

// Decimals are not exact: 12.3 - 12.1, 10.3 - 10.1 and 0.3 - 0.1 differ by rounding, 0.1 + 0.2 is
// not 0.3. Whole tenths have none of that, and hardly any size of unit changes an order.
TEST(Wilcoxon, OfDecimalsIsThatOfWholeTenthsInAnyUnit) {
  const std::vector<double> first{121, 101, 1, 3, 45, 7, 88, 30, 11, 64};
  const std::vector<double> second{123, 103, 3, 1, 41, 12, 88, 33, 9, 64};
  const auto whole = TestWilcoxon(first, second);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->zero_count, 2U);
  for (const double unit : {0.1, 1e-4, 1e-20, 1e20}) {
    SCOPED_TRACE(unit);
    std::vector<double> a;
    std::vector<double> b;
    for (std::size_t i = 0; i < first.size(); ++i) {
      a.push_back(unit * first[i]);
      b.push_back(unit * second[i]);
    }
    b[6] = unit * 80 + unit * 8;  // As much as a[6] but for rounding.
    const auto result = TestWilcoxon(a, b);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->zero_count, 2U);
    EXPECT_EQ(result->positive_rank_sum, whole->positive_rank_sum);
    EXPECT_EQ(*result->exact_p, *whole->exact_p);
    EXPECT_EQ(*result->z, *whole->z);
    EXPECT_EQ(*result->pratt_p, *whole->pratt_p);
  }
}

TEST(TieTolerance, IsAboveRoundingAndFarBelowWhatIsMeasured) {
  // Each of 1000 sums and differences of decimals is as the whole number of tenths says.
  Random random(20261129);
  for (int draw = 0; draw < 1000; ++draw) {
    const double a = std::floor(random.Uniform(1, 1e6));
    const double b = std::floor(random.Uniform(1, 1e6));
    const std::vector<double> first{0.1 * (a + b), 0.1 * a};
    const std::vector<double> second{0.1 * a + 0.1 * b, 0.1 * a * (1 + 1e-9)};
    const auto differences = CalcDifferences(first, second);
    ASSERT_TRUE(differences);
    EXPECT_EQ((*differences)[0], 0) << a << " + " << b;
    EXPECT_GT((*differences)[1], 0) << a;
  }
}

// Differences from nothing, or from what rounding has left of nothing, are as exact as the values.
TEST(TieTolerance, IsThatOfTheLargerSampleInEitherOrder) {
  const std::vector<double> nothing{0.1 + 0.2 - 0.3, 0, 0, 0};
  const std::vector<double> values{0, 0.1 + 0.2, 0.3, 0.7};
  ASSERT_NE(nothing[0], 0);
  ASSERT_NE(values[1], values[2]);
  const auto whole = TestWilcoxon(std::vector<double>{0, 0, 0, 0}, std::vector<double>{0, 3, 3, 7});
  const auto up = TestWilcoxon(nothing, values);
  const auto down = TestWilcoxon(values, nothing);
  ASSERT_TRUE(whole && up && down);
  EXPECT_EQ(up->zero_count, 1U);
  EXPECT_EQ(down->zero_count, 1U);
  EXPECT_EQ(*up->z, *whole->z);
  EXPECT_EQ(*down->z, -*whole->z);
}

/** All 2^n signs, by brute force. */
double EnumerateWilcoxon(const std::vector<double>& differences) {
  std::vector<double> sizes;
  double observed = 0;
  for (const double difference : differences) {
    if (difference != 0) {
      sizes.push_back(std::abs(difference));
    }
  }
  const std::vector<double> ranks = CalcMidRanks(sizes).ranks;
  std::size_t at = 0;
  for (const double difference : differences) {
    if (difference != 0) {
      observed += difference > 0 ? ranks[at] : -ranks[at];
      ++at;
    }
  }
  int as_far = 0;
  const unsigned count = 1U << ranks.size();
  for (unsigned signs = 0; signs < count; ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      sum += (signs >> i & 1U) != 0 ? ranks[i] : -ranks[i];
    }
    as_far += std::abs(sum) >= std::abs(observed) - 1e-9 ? 1 : 0;
  }
  return static_cast<double>(as_far) / count;
}

TEST(Wilcoxon, ExactIsTheShareOfAllSigns) {
  Random random(20260101);
  int with_ties = 0;
  for (int draw = 0; draw < 60; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw);
    const auto n = static_cast<std::size_t>(random.Uniform(3, 12));
    std::vector<double> first(n);
    std::vector<double> second(n);
    for (std::size_t i = 0; i < n; ++i) {
      first[i] = std::floor(random.Uniform(0, 8));
      second[i] = std::floor(random.Uniform(0, 10));
    }
    const auto result = TestWilcoxon(first, second);
    ASSERT_TRUE(result);
    if (result->n == 0) {
      continue;
    }
    const auto differences = CalcDifferences(first, second);
    EXPECT_NEAR(*result->exact_p, EnumerateWilcoxon(*differences), 1e-12);
    with_ties += result->zero_count > 0 ? 1 : 0;
  }
  EXPECT_GT(with_ties, 20);
}

// Without ties and with all n differences above zero the exact p is 2 / 2^n.
TEST(Wilcoxon, ExactOfOneSidedDifferencesIsKnownInClosedForm) {
  for (const std::size_t n : {1UL, 2UL, 5UL, 12UL, 60UL, 200UL}) {
    const std::vector<double> zero(n, 0.0);
    std::vector<double> above(n);
    std::iota(above.begin(), above.end(), 1.0);
    const auto result = TestWilcoxon(zero, above);
    ASSERT_TRUE(result);
    EXPECT_NEAR(*result->exact_p / std::pow(2, 1 - static_cast<double>(n)), 1, 1e-12) << n;
    EXPECT_DOUBLE_EQ(*result->rank_biserial, 1);
  }
}

TEST(Wilcoxon, SaysWhatIsNotDefined) {
  const auto equal = TestWilcoxon(std::vector<double>{1, 2}, std::vector<double>{1, 2});
  ASSERT_TRUE(equal);
  EXPECT_EQ(equal->zero_count, 2u);
  EXPECT_FALSE(equal->p || equal->exact_p || equal->z || equal->r || equal->rank_biserial);
  const std::vector<double> zero(201, 0.0);
  std::vector<double> above(201);
  std::iota(above.begin(), above.end(), 1.0);
  EXPECT_FALSE(TestWilcoxon(zero, above)->exact_p) << "too many for all signs";
  EXPECT_FALSE(TestWilcoxon(zero, std::vector<double>{1}));
  EXPECT_FALSE(TestWilcoxon(std::vector<double>{}, std::vector<double>{}));
  EXPECT_FALSE(TestWilcoxon(std::vector<double>{1}, std::vector<double>{std::nan("")}));
}

TEST(Wilcoxon, TiesOfDecimalsAreTiesInSpiteOfRounding) {
  // 0.2 each time, but 12.3 - 12.1 and 10.3 - 10.1 differ in the last place.
  const auto decimal = TestWilcoxon(std::vector<double>{12.1, 10.1, 5.0, 1.0},
                                    std::vector<double>{12.3, 10.3, 4.8, 1.5});
  const auto whole =
      TestWilcoxon(std::vector<double>{121, 101, 50, 10}, std::vector<double>{123, 103, 48, 15});
  EXPECT_EQ(decimal->positive_rank_sum, whole->positive_rank_sum);
  EXPECT_EQ(decimal->exact_p, whole->exact_p);
}

/** All orders of all rows, by brute force. */
double EnumerateFriedman(const std::vector<std::vector<double>>& rows) {
  std::vector<std::vector<double>> ranks;
  for (const auto& row : rows) {
    ranks.push_back(CalcMidRanks(row).ranks);
  }
  const std::size_t k = rows[0].size();
  const auto statistic = [&](const std::vector<std::vector<double>>& all) {
    double total = 0;
    for (std::size_t j = 0; j < k; ++j) {
      double sum = 0;
      for (const auto& row : all) {
        sum += row[j];
      }
      total += sum * sum;
    }
    return total;
  };
  const double observed = statistic(ranks);
  // Orders by position, so that tied ranks count as often as they should.
  std::vector<std::vector<std::size_t>> orders(1, std::vector<std::size_t>(k));
  std::iota(orders[0].begin(), orders[0].end(), std::size_t{0});
  while (true) {
    auto next = orders.back();
    if (!std::next_permutation(next.begin(), next.end())) {
      break;
    }
    orders.push_back(next);
  }
  std::size_t cases = 1;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    cases *= orders.size();
  }
  std::size_t as_far = 0;
  for (std::size_t i = 0; i < cases; ++i) {
    std::size_t rest = i;
    auto all = ranks;
    for (auto& row : all) {
      const auto& order = orders[rest % orders.size()];
      rest /= orders.size();
      const auto before = row;
      for (std::size_t j = 0; j < k; ++j) {
        row[j] = before[order[j]];
      }
    }
    as_far += statistic(all) >= observed - 1e-9 ? 1 : 0;
  }
  return static_cast<double>(as_far) / static_cast<double>(cases);
}

TEST(Friedman, ExactIsTheShareOfAllOrders) {
  Random random(20260102);
  for (int draw = 0; draw < 20; ++draw) {
    SCOPED_TRACE(::testing::Message() << "draw " << draw);
    const std::size_t k = draw % 4 == 0 ? 4 : 3;
    const std::size_t n = k == 4 ? 3 : 5;
    std::vector<std::vector<double>> rows(n, std::vector<double>(k));
    for (auto& row : rows) {
      for (double& value : row) {
        value = std::floor(random.Uniform(0, 5));
      }
    }
    const auto result = TestFriedman(rows);
    ASSERT_TRUE(result);
    if (result->exact_p) {
      EXPECT_NEAR(*result->exact_p, EnumerateFriedman(rows), 1e-12);
    }
  }
}

// Three judges of one mind on three things: one of 36 outcomes for the other two; all agree W = 1.
TEST(Friedman, OfFullAgreementIsKnownInClosedForm) {
  const auto result = TestFriedman(std::vector<std::vector<double>>(3, {1, 2, 3}));
  ASSERT_TRUE(result);
  EXPECT_DOUBLE_EQ(*result->chi_square, 6);
  EXPECT_DOUBLE_EQ(*result->kendall_w, 1);
  EXPECT_NEAR(*result->p, std::exp(-3.0), 1e-14);  // Two degrees of freedom.
  EXPECT_NEAR(*result->exact_p, 1.0 / 36, 1e-14);
  EXPECT_EQ(result->mean_ranks, (std::vector<double>{1, 2, 3}));
}

TEST(Friedman, DoesNotChangeWithTheOrderOfConditionsOrAScaleThatRises) {
  std::vector<std::vector<double>> rows;
  std::vector<std::vector<double>> other;
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    const double a = std::floor(random.Uniform(0, 6));
    const double b = std::floor(random.Uniform(0, 6));
    const double c = std::floor(random.Uniform(0, 9));
    rows.push_back({a, b, c});
    other.push_back({std::exp(c), std::exp(a), std::exp(b)});
  }
  EXPECT_NEAR(*TestFriedman(rows)->chi_square, *TestFriedman(other)->chi_square, 1e-12);
  EXPECT_NEAR(*TestFriedman(rows)->exact_p, *TestFriedman(other)->exact_p, 1e-12);
}

TEST(Friedman, SaysWhatIsNotDefined) {
  const auto tied = TestFriedman(std::vector<std::vector<double>>(4, {2, 2, 2}));
  ASSERT_TRUE(tied);
  EXPECT_FALSE(tied->chi_square || tied->p || tied->kendall_w || tied->exact_p);
  EXPECT_FALSE(TestFriedman(std::vector<std::vector<double>>{{1, 2, 3}}));
  EXPECT_FALSE(TestFriedman(std::vector<std::vector<double>>{{1}, {2}}));
  EXPECT_FALSE(TestFriedman(std::vector<std::vector<double>>{{1, 2}, {2}}));
  EXPECT_FALSE(TestFriedman(std::vector<std::vector<double>>{{1, 2}, {2, std::nan("")}}));
  const std::vector<std::vector<double>> wide(3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  EXPECT_TRUE(TestFriedman(wide)->p);
  EXPECT_FALSE(TestFriedman(wide)->exact_p) << "too many orders";
}

// Holm's own steps by hand: 3 p1, then 2 p2, then p3, never falling.
TEST(Adjustments, AreThoseOfAHandCalculation) {
  const std::vector<double> p{0.02, 0.01, 0.6};
  EXPECT_EQ(AdjustBonferroni(p), (std::vector<double>{0.06, 0.03, 1}));
  EXPECT_EQ(AdjustHolm(p), (std::vector<double>{0.04, 0.03, 0.6}));
  EXPECT_EQ(AdjustHolm(std::vector<double>{0.04, 0.03}), (std::vector<double>{0.06, 0.06}));
  EXPECT_TRUE(AdjustHolm({}).empty());
}

}  // namespace
}  // namespace hvas::statistics
