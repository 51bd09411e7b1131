#include "statistics/paired.h"

#include <cmath>
#include <vector>

#include "statistics/distributions.h"
#include "statistics/samples.h"

namespace hvas::statistics {
namespace {

/** The non-centrality under which a share of `below` of the non-central t distribution lies below
 `t`, by bisection: the share falls as the non-centrality grows. */
double FindNonCentrality(double t, double dof, double below) {
  constexpr int kSteps = 200;         // Halvings: more than a double has bits.
  constexpr int kMostDoublings = 20;  // Doublings of the interval: 2^20 is far beyond any t.
  double low = t - 1;
  double high = t + 1;
  for (int i = 0; i < kMostDoublings && CalcNonCentralStudent(t, dof, low) < below; ++i) {
    low = t - 2 * (t - low);
  }
  for (int i = 0; i < kMostDoublings && CalcNonCentralStudent(t, dof, high) > below; ++i) {
    high = t + 2 * (high - t);
  }
  for (int i = 0; i < kSteps && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) {
      break;
    }
    (CalcNonCentralStudent(t, dof, middle) > below ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Result<PairedDifference> ComparePairs(std::span<const double> first, std::span<const double> second,
                                      double confidence) {
  const auto differences = CalcDifferences(first, second);
  if (!differences) {
    return Unexpected(differences.error());
  }
  const auto summary = Summarise(*differences, confidence);
  const auto first_summary = Summarise(first, confidence);
  const auto second_summary = Summarise(second, confidence);
  if (!summary || !first_summary || !second_summary) {
    return Unexpected(summary.error());  // The samples are good: only the confidence may be wrong.
  }
  PairedDifference result{*summary, first_summary->mean, second_summary->mean, {}};
  if (result.first_mean > 0) {
    result.percent = 100 * (result.second_mean - result.first_mean) / result.first_mean;
  }
  return result;
}

Result<std::optional<StandardizedDifference>> CalcStandardizedDifference(
    std::span<const double> differences, double confidence) {
  const auto summary = Summarise(differences, confidence);
  if (!summary) {
    return Unexpected(summary.error());
  }
  if (!summary->sd || *summary->sd <= FindTieTolerance(differences)) {
    return std::optional<StandardizedDifference>{};
  }
  const auto n = static_cast<double>(summary->n);
  StandardizedDifference result;
  result.d_z = summary->mean / *summary->sd;
  const double t = result.d_z * std::sqrt(n);
  const double outside = 0.5 * (1 - confidence);
  result.ci.low = FindNonCentrality(t, n - 1, 1 - outside) / std::sqrt(n);
  result.ci.high = FindNonCentrality(t, n - 1, outside) / std::sqrt(n);
  return std::optional(result);
}

}  // namespace hvas::statistics
