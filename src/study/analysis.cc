#include "study/analysis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "statistics/samples.h"

namespace hvas::study {
namespace {

using statistics::Wilcoxon;

/** Limit of conditions: more are usually a mistake in the file, and their pairs unreadable. */
constexpr std::size_t kMaxColumns = 20;

Result<void> CheckOptions(const AnalysisOptions& options) {
  if (!(options.alpha > 0 && options.alpha < 0.5)) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} is not a significance level", options.alpha),
                "alpha", "give a number above 0 and below 0.5, such as 0.05");
  }
  if (options.of && *options.of < 1) {
    return Fail(ErrorCode::kInvalid, fmt::format("counts of {} trials", *options.of), "of",
                "give the trials of each cell, at least 1");
  }
  if (options.chance && !options.of) {
    return Fail(ErrorCode::kInvalid, "a chance level applies to counts of correct answers only",
                "chance", "give the number of trials for each count");
  }
  if (options.chance && !(*options.chance > 0 && *options.chance < 1)) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} is not a probability of guessing", *options.chance), "chance",
                "give a number between 0 and 1");
  }
  return {};
}

Result<void> CheckCell(const Table& table, const Row& row, std::size_t column,
                       const AnalysisOptions& options) {
  if (!row.values[column]) {
    return {};
  }
  const double value = *row.values[column];
  const auto where =
      fmt::format("participant {}, condition {}", row.participant, table.conditions[column]);
  if (!std::isfinite(value)) {
    return Fail(ErrorCode::kInvalid, "the value is not finite", where,
                "leave cells without a measurement empty");
  }
  if (options.of && (value < 0 || value > *options.of || value != std::floor(value))) {
    return Fail(
        ErrorCode::kInvalid,
        fmt::format("{} is not a count of correct answers in {} trials", value, *options.of), where,
        "give whole numbers from 0 to the number of trials");
  }
  return {};
}

Result<void> CheckTable(const Table& table, const AnalysisOptions& options) {
  if (table.conditions.size() < 2 || table.conditions.size() > kMaxColumns) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} conditions cannot be compared", table.conditions.size()), "table",
                fmt::format("give from 2 to {}, one for each column", kMaxColumns));
  }
  if (std::set<std::string>(table.conditions.begin(), table.conditions.end()).size() <
      table.conditions.size()) {
    return Fail(ErrorCode::kInvalid, "two conditions have the same name", "table",
                "give each a name of its own");
  }
  if (table.rows.size() < 2) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} participants are not enough", table.rows.size()), "table",
                "give at least two, one for each row");
  }
  std::set<std::string> names;
  for (const Row& row : table.rows) {
    if (!names.insert(row.participant).second) {
      return Fail(ErrorCode::kInvalid, "participant " + row.participant + " occurs twice", "table",
                  "give each participant one row");
    }
    if (row.values.size() != table.conditions.size()) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("{} cells, but {} conditions", row.values.size(), table.conditions.size()),
          "participant " + row.participant,
          "give one cell for each condition, empty where the value is missing");
    }
    for (std::size_t j = 0; j < row.values.size(); ++j) {
      if (auto checked = CheckCell(table, row, j, options); !checked) {
        return checked;
      }
    }
  }
  return {};
}

Result<ConditionResult> AnalyseCondition(const Table& table, std::size_t column,
                                         const AnalysisOptions& options, double chance) {
  std::vector<double> values;
  for (const Row& row : table.rows) {
    if (row.values[column]) {
      values.push_back(*row.values[column]);
    }
  }
  if (values.empty()) {
    return Fail(ErrorCode::kInvalid, "there are no values", "condition " + table.conditions[column],
                "omit the condition");
  }
  const auto summary = statistics::Summarise(values, 1 - options.alpha);
  if (!summary) {
    return Unexpected(summary.error());
  }
  ConditionResult result{table.conditions[column], *summary, {}};
  if (options.of) {
    double right = 0;
    for (const double value : values) {
      right += value;
    }
    const auto share = statistics::CalcShare(static_cast<std::int64_t>(right),
                                             static_cast<std::int64_t>(values.size()) * *options.of,
                                             chance, 1 - options.alpha);
    if (!share) {
      return Unexpected(share.error());
    }
    result.share = *share;
  }
  return result;
}

Result<void> AddFriedman(Analysis* analysis) {
  std::vector<std::vector<double>> rows;
  for (const Row& row : analysis->table.rows) {
    std::vector<double> values;
    for (const std::optional<double>& value : row.values) {
      if (value) {
        values.push_back(*value);
      }
    }
    if (values.size() == row.values.size()) {
      rows.push_back(std::move(values));
    }
  }
  analysis->complete_rows = rows.size();
  if (rows.size() < analysis->table.rows.size()) {
    analysis->notes.push_back(fmt::format(
        "{} of {} participants lack a condition: {}.", analysis->table.rows.size() - rows.size(),
        analysis->table.rows.size(),
        analysis->conditions.size() > 2 ? "the Friedman test omits them, a comparison of two "
                                          "conditions only where one of these is missing"
                                        : "the comparison omits them"));
  }
  if (analysis->conditions.size() < 3) {
    return {};
  }
  if (rows.size() < 2) {
    analysis->notes.emplace_back(
        "The Friedman test is not defined: fewer than two participants have all conditions.");
    return {};
  }
  const auto friedman = statistics::TestFriedman(rows);
  if (!friedman) {
    return Unexpected(friedman.error());
  }
  analysis->friedman = *friedman;
  if (!friedman->p) {
    analysis->notes.emplace_back(
        "The Friedman test is not defined: no participant's values differ between conditions.");
  } else if (!friedman->exact_p) {
    analysis->notes.emplace_back(
        "The exact p of the Friedman test would take too long for so many participants and "
        "conditions.");
  }
  return {};
}

Result<std::optional<PairResult>> ComparePair(const Analysis& analysis, std::size_t i,
                                              std::size_t j) {
  std::vector<double> first;
  std::vector<double> second;
  for (const Row& row : analysis.table.rows) {
    if (row.values[i] && row.values[j]) {
      first.push_back(*row.values[i]);
      second.push_back(*row.values[j]);
    }
  }
  if (first.empty()) {
    return std::optional<PairResult>{};
  }
  const double confidence = 1 - analysis.options.alpha;
  const auto difference = statistics::ComparePairs(first, second, confidence);
  const auto wilcoxon = statistics::TestWilcoxon(first, second);
  const auto differences = statistics::CalcDifferences(first, second);
  if (!difference || !wilcoxon || !differences) {
    return Unexpected(difference ? wilcoxon.error() : difference.error());
  }
  const auto d_z = statistics::CalcStandardizedDifference(*differences, confidence);
  if (!d_z) {
    return Unexpected(d_z.error());
  }
  PairResult pair;
  pair.first = i;
  pair.second = j;
  pair.difference = *difference;
  pair.wilcoxon = *wilcoxon;
  pair.d_z = *d_z;
  return std::optional(pair);
}

/** An undefined p counts as 1: no evidence of a difference. */
void Adjust(Analysis* analysis) {
  std::vector<double> p;
  std::vector<double> exact;
  bool is_exact = true;
  for (const PairResult& pair : analysis->pairs) {
    p.push_back(pair.wilcoxon.p.value_or(1));
    exact.push_back(pair.wilcoxon.exact_p.value_or(1));
    is_exact = is_exact && (pair.wilcoxon.exact_p || pair.wilcoxon.n == 0);
  }
  const std::vector<double> bonferroni = statistics::AdjustBonferroni(p);
  const std::vector<double> holm = statistics::AdjustHolm(p);
  const std::vector<double> exact_bonferroni = statistics::AdjustBonferroni(exact);
  const std::vector<double> exact_holm = statistics::AdjustHolm(exact);
  for (std::size_t i = 0; i < analysis->pairs.size(); ++i) {
    PairResult& pair = analysis->pairs[i];
    pair.bonferroni_p = bonferroni[i];
    pair.holm_p = holm[i];
    if (is_exact) {
      pair.exact_bonferroni_p = exact_bonferroni[i];
      pair.exact_holm_p = exact_holm[i];
    }
    pair.is_different = (is_exact ? exact_holm[i] : holm[i]) <= analysis->options.alpha;
  }
}

Result<void> AddPairs(Analysis* analysis) {
  const std::vector<std::string>& names = analysis->table.conditions;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const auto pair = ComparePair(*analysis, i, j);
      if (!pair) {
        return Unexpected(pair.error());
      }
      if (!*pair) {
        analysis->notes.push_back(fmt::format(
            "{} and {} are not compared: no participant has both.", names[i], names[j]));
        continue;
      }
      analysis->pairs.push_back(**pair);
      if (!(*pair)->wilcoxon.p) {
        analysis->notes.push_back(
            fmt::format("The Wilcoxon test of {} and {} is not defined: all differences are zero.",
                        names[i], names[j]));
      }
    }
  }
  if (analysis->pairs.empty()) {
    return Fail(ErrorCode::kInvalid, "no participant has two conditions", "table",
                "every participant needs values under the conditions that are compared");
  }
  analysis->bonferroni_level =
      analysis->options.alpha / static_cast<double>(analysis->pairs.size());
  Adjust(analysis);
  return {};
}

double Summarise(std::vector<double> values, TrialSummary summary) {
  if (summary == TrialSummary::kMedian) {
    std::sort(values.begin(), values.end());
    return statistics::CalcQuantile(values, 0.5);
  }
  double sum = 0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/** Finds the index of a name in a list; adds it when it is new. */
std::size_t FindOrAdd(const std::string& name, std::vector<std::string>* names) {
  const auto found = std::find(names->begin(), names->end(), name);
  if (found == names->end()) {
    names->push_back(name);
    return names->size() - 1;
  }
  return static_cast<std::size_t>(found - names->begin());
}

}  // namespace

Result<Analysis> Analyse(const Table& table, const AnalysisOptions& options) {
  if (const auto checked = CheckOptions(options); !checked) {
    return Unexpected(checked.error());
  }
  if (const auto checked = CheckTable(table, options); !checked) {
    return Unexpected(checked.error());
  }
  Analysis analysis;
  analysis.table = table;
  analysis.options = options;
  if (options.of) {
    analysis.chance = options.chance.value_or(1 / static_cast<double>(table.conditions.size()));
  }
  for (std::size_t j = 0; j < table.conditions.size(); ++j) {
    const auto condition = AnalyseCondition(table, j, options, analysis.chance);
    if (!condition) {
      return Unexpected(condition.error());
    }
    analysis.conditions.push_back(*condition);
  }
  if (const auto added = AddFriedman(&analysis); !added) {
    return Unexpected(added.error());
  }
  if (const auto added = AddPairs(&analysis); !added) {
    return Unexpected(added.error());
  }
  return analysis;
}

Table MakeTable(const std::vector<Trial>& trials, TrialSummary summary, std::string quantity,
                std::string unit) {
  Table table{std::move(quantity), std::move(unit), {}, {}};
  std::vector<std::string> participants;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> cells;
  for (const Trial& trial : trials) {
    const std::size_t row = FindOrAdd(trial.participant, &participants);
    cells[{row, FindOrAdd(trial.condition, &table.conditions)}].push_back(trial.value);
  }
  for (const std::string& participant : participants) {
    table.rows.push_back(
        {participant, std::vector<std::optional<double>>(table.conditions.size())});
  }
  for (const auto& [cell, values] : cells) {
    table.rows[cell.first].values[cell.second] = Summarise(values, summary);
  }
  return table;
}

Result<Identification> AnalyseIdentification(const std::vector<IdentificationAnswer>& answers,
                                             double alpha) {
  AnalysisOptions options;
  options.alpha = alpha;
  if (const auto checked = CheckOptions(options); !checked) {
    return Unexpected(checked.error());
  }
  Identification result;
  result.confidence = 1 - alpha;
  std::set<std::string> participants;
  for (const IdentificationAnswer& answer : answers) {
    participants.insert(answer.participant);
    FindOrAdd(answer.shown, &result.names);
  }
  result.participant_count = participants.size();
  const std::size_t shown_count = result.names.size();
  for (const IdentificationAnswer& answer : answers) {
    FindOrAdd(answer.answered, &result.names);
  }
  std::vector<std::vector<std::int64_t>> counts(result.names.size(),
                                                std::vector<std::int64_t>(result.names.size(), 0));
  for (const IdentificationAnswer& answer : answers) {
    const std::size_t shown = FindOrAdd(answer.shown, &result.names);
    ++counts[shown][FindOrAdd(answer.answered, &result.names)];
  }
  if (shown_count > 1) {
    result.chance = 1 / static_cast<double>(shown_count);
  }
  auto confusion = statistics::CalcConfusion(std::move(counts), result.chance, result.confidence);
  if (!confusion) {
    return Unexpected(confusion.error());
  }
  result.confusion = *std::move(confusion);
  return result;
}

}  // namespace hvas::study
