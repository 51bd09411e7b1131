#include "statistics/shares.h"

#include <fmt/format.h>

#include "statistics/distributions.h"

namespace hvas::statistics {

Result<Share> CalcShare(std::int64_t right, std::int64_t trials, std::optional<double> chance,
                        double confidence) {
  if (const auto checked = CheckConfidence(confidence); !checked) {
    return Unexpected(checked.error());
  }
  if (trials < 1 || right < 0 || right > trials) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} correct answers in {} trials", right, trials),
                "share", "give a count from 0 to the number of trials, and at least one trial");
  }
  if (chance && !(*chance > 0 && *chance < 1)) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} is not a probability of guessing", *chance),
                "chance", "give a number between 0 and 1");
  }
  Share result;
  result.right = right;
  result.trials = trials;
  const auto x = static_cast<double>(right);
  const auto n = static_cast<double>(trials);
  result.share = x / n;
  const double outside = 0.5 * (1 - confidence);
  result.ci.low = right == 0 ? 0 : CalcBetaQuantile(outside, x, n - x + 1);
  result.ci.high = right == trials ? 1 : CalcBetaQuantile(1 - outside, x + 1, n - x);
  if (chance) {
    result.chance_p = CalcBinomialUpper(right, trials, *chance);
  }
  return result;
}

Result<Confusion> CalcConfusion(std::vector<std::vector<std::int64_t>> counts,
                                std::optional<double> chance, double confidence) {
  const std::size_t size = counts.size();
  std::vector<std::int64_t> shown(size, 0);
  std::vector<std::int64_t> answered(size, 0);
  std::int64_t total = 0;
  std::int64_t right = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (counts[i].size() != size) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("row {} has {} cells of {}", i + 1, counts[i].size(), size),
                  "confusion matrix", "give as many rows as columns");
    }
    for (std::size_t j = 0; j < size; ++j) {
      if (counts[i][j] < 0) {
        return Fail(ErrorCode::kInvalid, fmt::format("{} answers", counts[i][j]),
                    fmt::format("confusion matrix, row {}, column {}", i + 1, j + 1),
                    "give counts of zero or more");
      }
      shown[i] += counts[i][j];
      answered[j] += counts[i][j];
    }
    right += counts[i][i];
    total += shown[i];
  }
  if (total == 0) {
    return Fail(ErrorCode::kInvalid, "there are no answers", "confusion matrix",
                "give at least one");
  }
  Confusion result;
  double by_chance = 0;
  for (std::size_t i = 0; i < size; ++i) {
    by_chance += static_cast<double>(shown[i]) / static_cast<double>(total) *
                 (static_cast<double>(answered[i]) / static_cast<double>(total));
    result.recall.emplace_back();
    if (shown[i] > 0) {
      const auto recall = CalcShare(counts[i][i], shown[i], chance, confidence);
      if (!recall) {
        return Unexpected(recall.error());
      }
      result.recall.back() = *recall;
    }
  }
  const auto accuracy = CalcShare(right, total, chance, confidence);
  if (!accuracy) {
    return Unexpected(accuracy.error());
  }
  result.accuracy = *accuracy;
  if (by_chance < 1) {
    result.kappa = (accuracy->share - by_chance) / (1 - by_chance);
  }
  result.counts = std::move(counts);
  return result;
}

}  // namespace hvas::statistics
