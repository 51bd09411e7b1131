// Descriptions of an analysis in words, for the page and the command.

#include <fmt/format.h>

#include "study/analysis.h"

namespace hvas::study {

std::string FormatP(double p) {
  constexpr double kLeast = 1e-4;  // Less is told as "below".
  return p < kLeast ? "< 0.0001" : p < 0.01 ? fmt::format("{:.5f}", p) : fmt::format("{:.4f}", p);
}

std::string DescribeFriedman(const Analysis& analysis) {
  if (!analysis.friedman || !analysis.friedman->p) {
    return {};
  }
  const statistics::Friedman& friedman = *analysis.friedman;
  // The exact test takes precedence: the other is its approximation.
  const double p = friedman.exact_p.value_or(*friedman.p);
  return fmt::format(
      "{}: Friedman chi-square {:.4f} with {} degrees of freedom, p {}{}, {}Kendall's W {:.3f}, {} "
      "participants.",
      p <= analysis.options.alpha ? "The conditions differ"
                                  : "No significant difference between the conditions",
      *friedman.chi_square, friedman.condition_count - 1, FormatP(*friedman.p),
      friedman.exact_p ? fmt::format(" (exact {})", FormatP(*friedman.exact_p)) : "",
      friedman.iman_davenport_f
          ? fmt::format("Iman and Davenport's F {:.4f} (p {}), ", *friedman.iman_davenport_f,
                        FormatP(*friedman.iman_davenport_p))
          : "",
      *friedman.kendall_w, friedman.row_count);
}

std::string DescribePair(const Analysis& analysis, const PairResult& pair) {
  if (!pair.is_different) {
    return "not shown";
  }
  const bool is_second_higher = pair.wilcoxon.positive_rank_sum > pair.wilcoxon.negative_rank_sum;
  const auto& names = analysis.table.conditions;
  const std::string& higher = names[is_second_higher ? pair.second : pair.first];
  const std::string& lower = names[is_second_higher ? pair.first : pair.second];
  switch (analysis.options.direction) {
    case Direction::kHigherIsBetter:
      return higher + " better";
    case Direction::kLowerIsBetter:
      return lower + " better";
    case Direction::kNotStated:
      break;
  }
  return higher + " higher";
}

std::vector<std::string> DescribeConventions(const Analysis& analysis) {
  const double level = 100 * (1 - analysis.options.alpha);
  std::vector<std::string> told{
      fmt::format(
          "Intervals have an individual confidence of {:g} %. Quartiles are linear between order "
          "statistics (type 7). Differences are second minus first, in per cent of the first mean.",
          level),
      fmt::format("Wilcoxon signed ranks: zero differences dropped, ties at mid ranks; p by the "
                  "normal approximation with corrected variance and without correction for "
                  "continuity, and exact by all signs. Both are two-sided. A difference is "
                  "significant where Holm's p, {}, is at most {:g}.",
                  !analysis.pairs.empty() && analysis.pairs.front().exact_holm_p
                      ? "of the exact test"
                      : "of the normal approximation",
                  analysis.options.alpha)};
  if (analysis.pairs.size() > 1) {
    told.push_back(
        fmt::format("Level of one of {} comparisons after Bonferroni: {:.4f}. Compare adjusted p "
                    "values with {:g} itself.",
                    analysis.pairs.size(), analysis.bonferroni_level, analysis.options.alpha));
  }
  if (analysis.options.of) {
    told.push_back(fmt::format(
        "Shares treat all trials of all participants as independent; where some participants are "
        "better than others, the true interval is wider. Chance: {:.4g}, {}; its p is one-sided.",
        analysis.chance,
        analysis.options.chance ? "as stated" : "one over the number of conditions"));
  }
  return told;
}

}  // namespace hvas::study
