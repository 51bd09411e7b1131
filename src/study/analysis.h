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

/** What one participant has under each condition. */
struct Row {
  std::string participant;
  std::vector<std::optional<double>> values;  ///< As many as there are conditions; none: missing.
};

/** Results of a study in which every participant meets every condition: one number a cell. */
struct Table {
  std::string quantity;  ///< What the numbers are: "completion time".
  std::string unit;      ///< "s"; empty for counts and scores.
  std::vector<std::string> conditions;
  std::vector<Row> rows;
};

/** What is wished for; changes words only, never a test. */
enum class Direction { kNotStated, kHigherIsBetter, kLowerIsBetter };

struct AnalysisOptions {
  double alpha{0.05};  ///< Level of all tests together, in (0, 0.5).
  Direction direction{Direction::kNotStated};
  /** Where cells are counts of right answers: of how many trials each. */
  std::optional<int> of;
  /** Probability of a right answer by guessing, in (0, 1); only with `of`. One in the number of
   conditions without it. */
  std::optional<double> chance;
};

/** The cells of one condition. */
struct ConditionResult {
  std::string name;
  statistics::Summary summary;
  /** Right answers of all participants together, where cells are counts. */
  std::optional<statistics::Share> share;
};

/** Two conditions, on the participants who have both. */
struct PairResult {
  std::size_t first{0};                     ///< Index of a condition.
  std::size_t second{0};                    ///< The same, larger.
  statistics::PairedDifference difference;  ///< Second minus first.
  statistics::Wilcoxon wilcoxon;
  std::optional<statistics::StandardizedDifference> d_z;  ///< None where differences are all equal.
  double bonferroni_p{1};                                 ///< Of the asymptotic p.
  double holm_p{1};                                       ///< The same.
  std::optional<double> exact_bonferroni_p;               ///< None where there is no exact p.
  std::optional<double> exact_holm_p;
  bool is_different{false};  ///< By Holm at alpha, on exact p where all pairs have one.
};

struct Analysis {
  Table table;
  AnalysisOptions options;
  std::vector<ConditionResult> conditions;
  std::size_t complete_rows{0};  ///< Participants with all conditions: those of the Friedman test.
  std::optional<statistics::Friedman> friedman;  ///< None with fewer than three conditions.
  std::vector<PairResult> pairs;
  double bonferroni_level{0};      ///< alpha over the number of pairs.
  double chance{0};                ///< Of a right answer; 0 where cells are no counts.
  std::vector<std::string> notes;  ///< What was left out, or is not defined, and why.
};

/** All tests of a table. Errors: kInvalid for fewer than two conditions, or participants, cells
 that are not finite or, as counts, not whole numbers from 0 to `of`, and options out of range; with
 the participant and condition. */
[[nodiscard]] Result<Analysis> Analyse(const Table& table, const AnalysisOptions& options);

/** What the Friedman test says, in a sentence; empty where there is none. Plain text. */
[[nodiscard]] std::string TellFriedman(const Analysis& analysis);

/** Which of a pair has more, or is better where that was stated: "B1 higher"; "not shown" where no
 difference is. Plain text. */
[[nodiscard]] std::string TellPair(const Analysis& analysis, const PairResult& pair);

/** How the figures are to be read: conventions of the tests that were made. Plain text, a paragraph
 each. */
[[nodiscard]] std::vector<std::string> TellConventions(const Analysis& analysis);

/** A probability as it is printed: "0.0128", "< 0.0001". */
[[nodiscard]] std::string FormatP(double p);

/** One trial of a long table. */
struct Trial {
  std::string participant;
  std::string condition;
  double value{0};
};

enum class TrialSummary { kMean, kMedian };

/** One number a participant and condition. Conditions and participants in the order in which they
 come first. */
[[nodiscard]] Table MakeTable(const std::vector<Trial>& trials, TrialSummary summary,
                              std::string quantity, std::string unit);

/** One answer of a blind identification. */
struct Answer {
  std::string participant;
  std::string shown;
  std::string answered;
};

/** What was taken for what. */
struct Identification {
  std::vector<std::string> names;   ///< Shown first, then only answered; as they come.
  statistics::Confusion confusion;  ///< [shown][answered], in the order of `names`.
  std::size_t participant_count{0};
  double confidence{0.95};
  std::optional<double> chance;  ///< Of a right answer by guessing; none where one thing is shown.
};

/** Chance is one in the number of things shown. Errors: kInvalid for no answers. */
[[nodiscard]] Result<Identification> AnalyseIdentification(const std::vector<Answer>& answers,
                                                           double alpha = 0.05);

}  // namespace hvas::study
