#include "base/histogram.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas {
namespace {

TEST(LatencyHistogram, IsZeroWhenEmpty) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.Quantile(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), 0);
  EXPECT_EQ(histogram.mean_ns(), 0);
}

TEST(LatencyHistogram, IsExactForSmallValues) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 50; ++i) {
    histogram.Add(i);
  }
  EXPECT_EQ(histogram.Quantile(0.0), 1);
  EXPECT_EQ(histogram.Quantile(0.5), 25);
  EXPECT_EQ(histogram.Quantile(0.9), 45);
  EXPECT_EQ(histogram.Quantile(1.0), 50);
  EXPECT_DOUBLE_EQ(histogram.mean_ns(), 25.5);
}

TEST(LatencyHistogram, QuantilesStayWithinAThirtySecondOfTheSortedValues) {
  Random random(11);
  LatencyHistogram histogram;
  std::vector<std::int64_t> values;
  for (int i = 0; i < 20000; ++i) {
    // Log-uniform over eight decades, as latencies with rare outliers are.
    values.push_back(static_cast<std::int64_t>(std::pow(10, random.Uniform(1, 9))));
    histogram.Add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const double p : {0.001, 0.01, 0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 0.9999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(p * 20000)) - 1;
    const auto exact = static_cast<double>(values[rank]);
    const auto found = static_cast<double>(histogram.Quantile(p));
    EXPECT_GE(found, exact) << p;
    EXPECT_LE(found, exact * (1 + 1.0 / 32)) << p;
  }
  EXPECT_EQ(histogram.Quantile(1.0), values.back());
  EXPECT_EQ(histogram.max_ns(), values.back());
}

TEST(LatencyHistogram, TakesTheWholeRange) {
  LatencyHistogram histogram;
  histogram.Add(-5);
  EXPECT_EQ(histogram.Quantile(1.0), 0);
  histogram.Add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.Quantile(1.0), std::numeric_limits<std::int64_t>::max());
  for (int bit = 0; bit < 63; ++bit) {
    LatencyHistogram one;
    one.Add(std::int64_t{1} << bit);
    EXPECT_EQ(one.Quantile(0.5), std::int64_t{1} << bit);
  }
}

TEST(LatencyHistogram, MergingIsTheSameAsAddingToOne) {
  Random random(12);
  LatencyHistogram whole;
  LatencyHistogram left;
  LatencyHistogram right;
  for (int i = 0; i < 1000; ++i) {
    const auto value = static_cast<std::int64_t>(random.Uniform(0, 1e6));
    whole.Add(value);
    (i % 3 == 0 ? left : right).Add(value);
  }
  left.Merge(right);
  EXPECT_EQ(left.count(), whole.count());
  EXPECT_EQ(left.max_ns(), whole.max_ns());
  EXPECT_DOUBLE_EQ(left.mean_ns(), whole.mean_ns());
  for (double p = 0; p <= 1; p += 0.01) {
    EXPECT_EQ(left.Quantile(p), whole.Quantile(p));
  }
}

}  // namespace
}  // namespace hvas
