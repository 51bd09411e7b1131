#include "statistics/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

#include <fmt/format.h>

#include "statistics/distributions.h"
#include "statistics/samples.h"

namespace hvas::statistics {
namespace {

/** Steps of the exact Friedman distribution that are worth the wait: some tenths of a second. */
constexpr std::size_t kMostFriedmanSteps = 2'000'000;

using Sums = std::vector<int>;

/** Mid ranks are halves: doubled they are whole. */
int Doubled(double rank) {
  return static_cast<int>(std::lround(2 * rank));
}

/** Orders of one row's doubled ranks that differ; each stands for as many of all. */
std::vector<Sums> ListOrders(Sums ranks) {
  std::sort(ranks.begin(), ranks.end());
  std::vector<Sums> orders;
  do {
    orders.push_back(ranks);
  } while (std::next_permutation(ranks.begin(), ranks.end()));
  return orders;
}

std::int64_t CalcSquares(const Sums& sums) {
  return std::accumulate(
      sums.begin(), sums.end(), std::int64_t{0},
      [](std::int64_t total, int sum) { return total + static_cast<std::int64_t>(sum) * sum; });
}

/** Sums of some rows in one number, for what can be compared fast: sorted, 12 bits each. */
constexpr int kBitsOfSum = 12;
constexpr std::size_t kMostPacked = 5;

std::uint64_t Pack(Sums* sums) {
  std::sort(sums->begin(), sums->end());
  return std::accumulate(sums->begin(), sums->end(), std::uint64_t{0},
                         [](std::uint64_t key, int sum) {
                           return key << kBitsOfSum | static_cast<std::uint64_t>(sum);
                         });
}

Sums Unpack(std::uint64_t key, std::size_t size) {
  Sums sums(size);
  for (std::size_t j = size; j-- > 0; key >>= kBitsOfSum) {
    sums[j] = static_cast<int>(key & ((1U << kBitsOfSum) - 1));
  }
  return sums;
}

/** How probable each is; sorted by key, and each key once. */
using Distribution = std::vector<std::pair<std::uint64_t, double>>;

/** Adds up what has the same key. */
void Merge(Distribution* states) {
  std::sort(states->begin(), states->end());
  std::size_t kept = 0;
  for (std::size_t i = 1; i < states->size(); ++i) {
    if ((*states)[i].first == (*states)[kept].first) {
      (*states)[kept].second += (*states)[i].second;
    } else {
      (*states)[++kept] = (*states)[i];
    }
  }
  states->resize(kept + 1);
}

/** P(sum of squared rank sums as large or larger) when each row's ranks stand in any order. Sums
 are kept sorted: no column is unlike another, so only their multiset counts. */
std::optional<double> CalcExactFriedman(const std::vector<Sums>& rows, const Sums& observed) {
  const std::size_t size = observed.size();
  if (size > kMostPacked || 2 * size * rows.size() >= 1U << kBitsOfSum) {
    return std::nullopt;
  }
  Distribution states{{0, 1.0}};
  std::size_t steps = 0;
  for (const Sums& row : rows) {
    const std::vector<Sums> orders = ListOrders(row);
    const double share = 1 / static_cast<double>(orders.size());
    steps += states.size() * orders.size();
    if (steps > kMostFriedmanSteps) {
      return std::nullopt;
    }
    Distribution next;
    next.reserve(states.size() * orders.size());
    for (const auto& state : states) {
      const Sums sums = Unpack(state.first, size);
      Sums added(size);
      for (const Sums& order : orders) {
        std::transform(sums.begin(), sums.end(), order.begin(), added.begin(), std::plus<>());
        next.emplace_back(Pack(&added), state.second * share);
      }
    }
    Merge(&next);
    states = std::move(next);
  }
  const std::int64_t squares = CalcSquares(observed);
  double p = 0;
  for (const auto& state : states) {
    p += CalcSquares(Unpack(state.first, size)) >= squares ? state.second : 0;
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

double CalcTwoSided(double z) {
  return std::min(1.0, 2 * CalcNormalUpper(std::abs(z)));
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
          "Friedman test", "omit incomplete rows");
    }
    if (auto checked = CheckSample(rows[i]); !checked) {
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

Result<Friedman> TestFriedman(std::span<const std::vector<double>> rows, Exact exact) {
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
    const double rest = n * (k - 1) - *result.chi_square;
    if (rest > 1e-9 * n) {
      result.iman_davenport_f = (n - 1) * *result.chi_square / rest;
      result.iman_davenport_p = CalcFisherUpper(*result.iman_davenport_f, k - 1, (k - 1) * (n - 1));
    }
    if (exact == Exact::kYes) {
      result.exact_p = CalcExactFriedman(ranks, sums);
    }
  }
  return result;
}

Result<Wilcoxon> TestWilcoxon(std::span<const double> first, std::span<const double> second,
                              Exact exact) {
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
  const double distance = result.positive_rank_sum - 0.25 * n * (n + 1);
  result.z = distance / std::sqrt(variance);
  result.p = CalcTwoSided(*result.z);
  result.continuity_p = CalcTwoSided(std::max(0.0, std::abs(distance) - 0.5) / std::sqrt(variance));
  // Pratt's ranks are larger by the zeros; the sums, means and variances follow from that.
  const auto zeros = static_cast<double>(result.zero_count);
  const auto all = n + zeros;
  const auto positive_count =
      static_cast<double>(std::count(is_positive.begin(), is_positive.end(), true));
  const double pratt_sum = result.positive_rank_sum + zeros * positive_count;
  const double pratt_variance =
      (all * (all + 1) * (2 * all + 1) - zeros * (zeros + 1) * (2 * zeros + 1)) / 24 -
      mid.tie_sum / 48;
  result.pratt_z =
      (pratt_sum - 0.25 * (all * (all + 1) - zeros * (zeros + 1))) / std::sqrt(pratt_variance);
  result.pratt_p = CalcTwoSided(*result.pratt_z);
  if (exact == Exact::kYes && result.n <= kMostExactPairs) {
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
