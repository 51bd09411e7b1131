#include "statistics/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "statistics/distributions.h"
#include "statistics/samples.h"

namespace hvas::statistics {
namespace {

/** Steps of the exact Friedman distribution that are worth the wait, about a second. */
constexpr std::size_t kMostFriedmanSteps = 4'000'000;

using Sums = std::vector<int>;

/** Mid ranks are halves: doubled they are whole. */
int Doubled(double rank) {
  return static_cast<int>(std::lround(2 * rank));
}

/** Orders of one row's doubled ranks, each with its share of all. */
std::vector<std::pair<Sums, double>> ListOrders(Sums ranks) {
  std::sort(ranks.begin(), ranks.end());
  std::vector<std::pair<Sums, double>> orders;
  do {
    orders.emplace_back(ranks, 0);
  } while (std::next_permutation(ranks.begin(), ranks.end()));
  for (auto& order : orders) {
    order.second = 1 / static_cast<double>(orders.size());
  }
  return orders;
}

std::int64_t CalcSquares(const Sums& sums) {
  return std::accumulate(
      sums.begin(), sums.end(), std::int64_t{0},
      [](std::int64_t total, int sum) { return total + static_cast<std::int64_t>(sum) * sum; });
}

/** P(sum of squared rank sums as large or larger) when each row's ranks stand in any order. Sums
 are kept sorted: no column is unlike another, so only their multiset counts. */
std::optional<double> CalcExactFriedman(const std::vector<Sums>& rows, const Sums& observed) {
  constexpr std::size_t kMostConditions = 8;
  if (observed.size() > kMostConditions) {
    return std::nullopt;
  }
  std::map<Sums, double> states{{Sums(observed.size(), 0), 1.0}};
  std::size_t steps = 0;
  for (const Sums& row : rows) {
    const auto orders = ListOrders(row);
    steps += states.size() * orders.size();
    if (steps > kMostFriedmanSteps) {
      return std::nullopt;
    }
    std::map<Sums, double> next;
    for (const auto& [sums, share] : states) {
      for (const auto& [order, order_share] : orders) {
        Sums added(sums);
        for (std::size_t j = 0; j < added.size(); ++j) {
          added[j] += order[j];
        }
        std::sort(added.begin(), added.end());
        next[std::move(added)] += share * order_share;
      }
    }
    states = std::move(next);
  }
  const std::int64_t squares = CalcSquares(observed);
  double p = 0;
  for (const auto& [sums, share] : states) {
    p += CalcSquares(sums) >= squares ? share : 0;
  }
  return std::min(p, 1.0);
}

/** P(|W - E W| as large or larger) over all signs of doubled ranks. `positive` is their sum with a
 positive sign. */
double CalcExactWilcoxon(const Sums& ranks, int positive) {
  const int total = std::accumulate(ranks.begin(), ranks.end(), 0);
  std::vector<double> shares(static_cast<std::size_t>(total) + 1, 0.0);
  shares[0] = 1;
  int reached = 0;
  for (const int rank : ranks) {
    reached += rank;
    for (int sum = reached; sum >= 0; --sum) {
      const auto at = static_cast<std::size_t>(sum);
      shares[at] =
          0.5 * (shares[at] + (sum >= rank ? shares[at - static_cast<std::size_t>(rank)] : 0));
    }
  }
  const int distance = std::abs(2 * positive - total);
  double p = 0;
  for (int sum = 0; sum <= total; ++sum) {
    p += std::abs(2 * sum - total) >= distance ? shares[static_cast<std::size_t>(sum)] : 0;
  }
  return std::min(p, 1.0);
}

Result<void> CheckRows(std::span<const std::vector<double>> rows) {
  if (rows.size() < 2 || rows[0].size() < 2) {
    return Fail(
        ErrorCode::kInvalid,
        fmt::format("{} rows of {} conditions", rows.size(), rows.empty() ? 0 : rows[0].size()),
        "Friedman test", "give at least two of each");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != rows[0].size()) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("row {} has {} values, the first {}", i + 1, rows[i].size(), rows[0].size()),
          "Friedman test", "leave out rows that are not complete");
    }
    if (const auto checked = CheckSample(rows[i]); !checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace

MidRanks CalcMidRanks(std::span<const double> values, double tolerance) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  MidRanks result{std::vector<double>(values.size()), 0};
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    end = begin + 1;
    while (end < order.size() && values[order[end]] - values[order[end - 1]] <= tolerance) {
      ++end;
    }
    const auto tied = static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      result.ranks[order[i]] = 0.5 * static_cast<double>(begin + 1 + end);
    }
    result.tie_sum += tied * tied * tied - tied;
  }
  return result;
}

Result<Friedman> TestFriedman(std::span<const std::vector<double>> rows) {
  if (const auto checked = CheckRows(rows); !checked) {
    return Unexpected(checked.error());
  }
  Friedman result;
  result.row_count = rows.size();
  result.condition_count = rows[0].size();
  Sums sums(result.condition_count, 0);  // Of doubled ranks.
  std::vector<Sums> ranks;
  double tie_sum = 0;
  for (const std::vector<double>& row : rows) {
    const MidRanks mid = CalcMidRanks(row, FindTieTolerance(row));
    Sums doubled;
    for (std::size_t j = 0; j < row.size(); ++j) {
      doubled.push_back(Doubled(mid.ranks[j]));
      sums[j] += doubled.back();
    }
    ranks.push_back(std::move(doubled));
    tie_sum += mid.tie_sum;
  }
  const auto n = static_cast<double>(result.row_count);
  const auto k = static_cast<double>(result.condition_count);
  double squares = 0;
  for (const int sum : sums) {
    result.mean_ranks.push_back(0.5 * sum / n);
    squares += (0.5 * sum - 0.5 * n * (k + 1)) * (0.5 * sum - 0.5 * n * (k + 1));
  }
  const double scale = n * k * (k + 1) - tie_sum / (k - 1);
  if (scale > 0.5) {  // A whole number over k - 1; zero where every row is one tie.
    result.chi_square = 12 * squares / scale;
    result.p = CalcChiSquareUpper(*result.chi_square, k - 1);
    result.kendall_w = *result.chi_square / (n * (k - 1));
    result.exact_p = CalcExactFriedman(ranks, sums);
  }
  return result;
}

Result<Wilcoxon> TestWilcoxon(std::span<const double> first, std::span<const double> second) {
  const auto differences = CalcDifferences(first, second);
  if (!differences) {
    return Unexpected(differences.error());
  }
  Wilcoxon result;
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (const double difference : *differences) {
    if (difference != 0) {
      sizes.push_back(std::abs(difference));
      is_positive.push_back(difference > 0);
    }
  }
  result.n = sizes.size();
  result.zero_count = differences->size() - sizes.size();
  if (sizes.empty()) {
    return result;
  }
  const MidRanks mid =
      CalcMidRanks(sizes, std::max(FindTieTolerance(first), FindTieTolerance(second)));
  Sums doubled;
  int positive = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    (is_positive[i] ? result.positive_rank_sum : result.negative_rank_sum) += mid.ranks[i];
    doubled.push_back(Doubled(mid.ranks[i]));
    positive += is_positive[i] ? doubled.back() : 0;
  }
  const auto n = static_cast<double>(result.n);
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - mid.tie_sum / 48;
  result.z = (result.positive_rank_sum - 0.25 * n * (n + 1)) / std::sqrt(variance);
  result.p = std::min(1.0, 2 * CalcNormalUpper(std::abs(*result.z)));
  if (result.n <= kMostExactPairs) {
    result.exact_p = CalcExactWilcoxon(doubled, positive);
  }
  result.rank_biserial =
      (result.positive_rank_sum - result.negative_rank_sum) / (0.5 * n * (n + 1));
  result.r = *result.z / std::sqrt(n);
  return result;
}

std::vector<double> AdjustBonferroni(std::span<const double> p) {
  std::vector<double> adjusted(p.begin(), p.end());
  for (double& value : adjusted) {
    value = std::min(1.0, value * static_cast<double>(p.size()));
  }
  return adjusted;
}

std::vector<double> AdjustHolm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [p](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, p[order[i]] * static_cast<double>(p.size() - i)));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace hvas::statistics
