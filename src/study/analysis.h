#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "statistics/paired.h"
#include "statistics/rank_tests.h"
#include "statistics/shares.h"
#include "statistics/summary.h"

namespace hvas::study {

/** Values of one participant, one for each condition. */
struct Row {
  std::string participant;
  std::vector<std::optional<double>> values;  ///< One for each condition; none: missing.
};

/** Results of a within-subjects design: one number for each participant and condition. */
struct Table {
  std::string quantity;  ///< Name of the dependent variable: "completion time".
  std::string unit;      ///< Unit: "s"; empty for counts and scores.
  std::vector<std::string> conditions;
  std::vector<Row> rows;
};

/** Which direction is better; affects the wording only, never a test. */
enum class Direction { kNotStated, kHigherIsBetter, kLowerIsBetter };

struct AnalysisOptions {
  double alpha{0.05};  ///< Family-wise significance level, in (0, 0.5).
  Direction direction{Direction::kNotStated};
  /** Number of trials for each cell, where cells are counts of correct answers. */
  std::optional<int> of;
  /** Probability of a correct answer by guessing, in (0, 1); only with `of`. Default: one over the
   number of conditions. */
  std::optional<double> chance;
};

/** Descriptive statistics of one condition. */
struct ConditionResult {
  std::string name;
  statistics::Summary summary;
  /** Pooled share of correct answers, where cells are counts. */
  std::optional<statistics::Share> share;
};

/** Comparison of two conditions, on the participants who have both. */
struct PairResult {
  std::size_t first{0};                     ///< Index of a condition.
  std::size_t second{0};                    ///< Index of a condition, larger than `first`.
  statistics::PairedDifference difference;  ///< Second minus first.
  statistics::Wilcoxon wilcoxon;
  std::optional<statistics::StandardizedDifference> d_z;  ///< None where all differences are equal.
  double bonferroni_p{1};                                 ///< Asymptotic p, adjusted by Bonferroni.
  double holm_p{1};                                       ///< Asymptotic p, adjusted by Holm.
  std::optional<double> exact_bonferroni_p;               ///< None where there is no exact p.
  std::optional<double> exact_holm_p;
  bool is_different{false};  ///< Significant by Holm at alpha; exact p where all pairs have one.
};

struct Analysis {
  Table table;
  AnalysisOptions options;
  std::vector<ConditionResult> conditions;
  std::size_t complete_rows{0};  ///< Participants with all conditions: the Friedman test's sample.
  std::optional<statistics::Friedman> friedman;  ///< None with fewer than three conditions.
  std::vector<PairResult> pairs;
  double bonferroni_level{0};      ///< alpha over the number of pairs.
  double chance{0};                ///< See AnalysisOptions; 0 where cells are no counts.
  std::vector<std::string> notes;  ///< What was omitted or is undefined, with the reason.
};

/** Runs all tests on a table. Errors: kInvalid, with participant and condition, for fewer than two
 conditions or participants, for cells that are not finite or, as counts, no integers from 0 to
 `of`, and for options out of range. */
[[nodiscard]] Result<Analysis> Analyse(const Table& table, const AnalysisOptions& options);

/** Describes the result of the Friedman test in a sentence; empty where there is none. Plain
 text. */
[[nodiscard]] std::string DescribeFriedman(const Analysis& analysis);

/** Describes which condition of a pair is higher, or better where a direction was stated: "B1
 higher"; "not shown" where no difference is significant. Plain text. */
[[nodiscard]] std::string DescribePair(const Analysis& analysis, const PairResult& pair);

/** Describes the conventions of the tests and figures of an analysis. Plain text, one paragraph for
 each. */
[[nodiscard]] std::vector<std::string> DescribeConventions(const Analysis& analysis);

/** Formats a p value: "0.0128", "< 0.0001". */
[[nodiscard]] std::string FormatP(double p);

/** One trial of a long table. */
struct Trial {
  std::string participant;
  std::string condition;
  double value{0};
};

enum class TrialSummary { kMean, kMedian };

/** Summarises trials to one number for each participant and condition, both in the order of their
 first occurrence. */
[[nodiscard]] Table MakeTable(const std::vector<Trial>& trials, TrialSummary summary,
                              std::string quantity, std::string unit);

/** One trial of a blind identification: stimulus and response. */
struct IdentificationAnswer {
  std::string participant;
  std::string shown;     ///< Name of the stimulus.
  std::string answered;  ///< Name that the participant gave.
};

/** Results of a blind identification. */
struct Identification {
  std::vector<std::string> names;   ///< Stimuli first, then other responses; by first occurrence.
  statistics::Confusion confusion;  ///< [shown][answered], in the order of `names`.
  std::size_t participant_count{0};
  double confidence{0.95};
  std::optional<double> chance;  ///< Chance level; none with a single stimulus.
};

/** Analyses an identification; chance is one over the number of stimuli. Errors: kInvalid for
 none. */
[[nodiscard]] Result<Identification> AnalyseIdentification(
    const std::vector<IdentificationAnswer>& answers, double alpha = 0.05);

}  // namespace hvas::study
