#include "app/study_analyse.h"

#include <algorithm>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/page_file.h"
#include "app/report_failure.h"
#include "app/study_json.h"
#include "app/study_table.h"
#include "app/text_layout.h"
#include "pages/html_page.h"
#include "study/analysis_page.h"

namespace hvas::app {
namespace {

struct AnalyseArguments {
  StudyTableOptions table;
  study::AnalysisOptions options;
  std::filesystem::path output;
  bool is_forced{false};
  bool is_json{false};
};

std::string Format(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

std::string Format(const std::optional<statistics::Interval>& interval) {
  return interval ? fmt::format("{:.4g} to {:.4g}", interval->low, interval->high) : "-";
}

std::string FormatP(const std::optional<double>& p) {
  return p ? study::FormatP(*p) : "-";
}

/** The first column, as wide as the pairs that stand in it need. */
class NameColumn {
 public:
  explicit NameColumn(const std::vector<std::string>& names, bool has_pairs) {
    constexpr std::size_t kLeast = 18;
    constexpr std::size_t kMost = 50;
    std::vector<std::size_t> widths{0, 0};
    for (const std::string& name : names) {
      widths.push_back(CalcWidth(name));
    }
    std::sort(widths.rbegin(), widths.rend());
    const std::size_t pair = widths[0] + widths[1] + CalcWidth(" - ");
    width_ = std::clamp(has_pairs ? pair : widths[0], kLeast, kMost);
  }

  [[nodiscard]] std::string operator()(const std::string& name) const {
    return PadTo(Shorten(name, width_), width_);
  }

 private:
  std::size_t width_;
};

void PrintConditions(const study::Analysis& analysis, const NameColumn& name) {
  const std::string level = fmt::format("{:g} % of mean", 100 * (1 - analysis.options.alpha));
  fmt::print("{}{:>4}{:>9}{:>20}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", name(""), "n", "mean", level,
             "SD", "least", "quart.", "median", "quart.", "largest");
  for (const study::ConditionResult& condition : analysis.conditions) {
    const statistics::Summary& s = condition.summary;
    fmt::print("{}{:>4}{:>9}{:>20}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", name(condition.name), s.n,
               Format(s.mean), Format(s.mean_ci), Format(s.sd), Format(s.min),
               Format(s.lower_quartile), Format(s.median), Format(s.upper_quartile), Format(s.max));
  }
  if (!analysis.options.of) {
    return;
  }
  fmt::print("\n{}{:>7}{:>8}{:>9}{:>20}{:>24}\n", name("right answers"), "right", "trials", "share",
             fmt::format("{:g} % of share", 100 * (1 - analysis.options.alpha)),
             fmt::format("p against {:.3g} %", 100 * analysis.chance));
  for (const study::ConditionResult& condition : analysis.conditions) {
    const statistics::Share& share = *condition.share;
    fmt::print("{}{:>7}{:>8}{:>7.1f} %{:>20}{:>24}\n", name(condition.name), share.right,
               share.trials, 100 * share.share,
               fmt::format("{:.1f} to {:.1f} %", 100 * share.ci.low, 100 * share.ci.high),
               FormatP(share.chance_p));
  }
}

std::string PairName(const study::Analysis& analysis, const study::PairResult& pair) {
  return analysis.table.conditions[pair.first] + " - " + analysis.table.conditions[pair.second];
}

void PrintPairs(const study::Analysis& analysis, const NameColumn& name) {
  fmt::print("\n{}{:>4}{:>6}{:>9}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}  {}\n", name("Wilcoxon"), "n",
             "zero", "Z", "p", "Bonferr.", "Holm", "exact p", "Bonferr.", "Holm", "difference");
  for (const study::PairResult& pair : analysis.pairs) {
    const statistics::Wilcoxon& w = pair.wilcoxon;
    fmt::print("{}{:>4}{:>6}{:>9}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}  {}\n",
               name(PairName(analysis, pair)), w.n, w.zero_count, Format(w.z), FormatP(w.p),
               FormatP(pair.bonferroni_p), FormatP(pair.holm_p), FormatP(w.exact_p),
               FormatP(pair.exact_bonferroni_p), FormatP(pair.exact_holm_p),
               study::TellPair(analysis, pair));
  }
  const std::string level = fmt::format("{:g} %", 100 * (1 - analysis.options.alpha));
  fmt::print("\n{}{:>9}{:>20}{:>9}{:>9}{:>9}{:>20}{:>10}{:>9}\n", name("second - first"), "mean",
             level + " of mean", "median", "per cent", "d_z", level + " of d_z", "biserial",
             "Z/rt(n)");
  for (const study::PairResult& pair : analysis.pairs) {
    const statistics::Summary& s = pair.difference.summary;
    std::optional<double> d_z;
    std::optional<statistics::Interval> d_z_ci;
    if (pair.d_z) {
      d_z = pair.d_z->d_z;
      d_z_ci = pair.d_z->ci;
    }
    fmt::print("{}{:>9}{:>20}{:>9}{:>9}{:>9}{:>20}{:>10}{:>9}\n", name(PairName(analysis, pair)),
               Format(s.mean), Format(s.mean_ci), Format(s.median), Format(pair.difference.percent),
               Format(d_z), Format(d_z_ci), Format(pair.wilcoxon.rank_biserial),
               Format(pair.wilcoxon.r));
  }
}

void PrintParagraphs(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    fmt::print("{}", Wrap(text, 0));
  }
}

void PrintText(const study::Analysis& analysis, const std::vector<std::string>& notes) {
  const study::Table& table = analysis.table;
  fmt::print("{}{}, {} participants, {} conditions\n\n", table.quantity,
             table.unit.empty() ? "" : fmt::format(" [{}]", table.unit), table.rows.size(),
             table.conditions.size());
  const NameColumn name(table.conditions, true);
  PrintConditions(analysis, name);
  const std::string told = study::TellFriedman(analysis);
  if (!told.empty()) {
    fmt::print("\n{}", Wrap(told, 0));
  }
  PrintPairs(analysis, name);
  fmt::print("\n");
  PrintParagraphs(notes);
  PrintParagraphs(analysis.notes);
  PrintParagraphs(study::TellConventions(analysis));
}

void PrintText(const study::Identification& identification) {
  const statistics::Confusion& confusion = identification.confusion;
  const NameColumn name(identification.names, false);
  fmt::print("{} answers of {} participants\n\n{}", confusion.accuracy.trials,
             identification.participant_count, name("shown \\ answered"));
  for (const std::string& answered : identification.names) {
    fmt::print("{:>12}", Shorten(answered, 11));
  }
  fmt::print("{:>10}{:>20}\n", "right",
             fmt::format("{:g} % of share", 100 * identification.confidence));
  const auto tell = [](const statistics::Share& share) {
    return fmt::format("{:>8.1f} %{:>20}", 100 * share.share,
                       fmt::format("{:.1f} to {:.1f} %", 100 * share.ci.low, 100 * share.ci.high));
  };
  for (std::size_t i = 0; i < identification.names.size(); ++i) {
    fmt::print("{}", name(identification.names[i]));
    for (const std::int64_t count : confusion.counts[i]) {
      fmt::print("{:>12}", count);
    }
    fmt::print("{}\n", confusion.recall[i] ? tell(*confusion.recall[i]) : "");
  }
  fmt::print("{}{:>{}}{}\n\nCohen's kappa {}", name("all"), "", 12 * identification.names.size(),
             tell(confusion.accuracy),
             confusion.kappa ? fmt::format("{:.4f}", *confusion.kappa) : "is not defined");
  if (identification.chance) {
    fmt::print("; p against chance ({:.3g} %) {}", 100 * *identification.chance,
               FormatP(confusion.accuracy.chance_p));
  }
  fmt::print(
      "\nIntervals of Clopper and Pearson; all answers are taken as independent, also those of "
      "one\nparticipant.\n");
}

Result<void> Show(const AnalyseArguments& a, const nlohmann::ordered_json& json,
                  const std::string& html) {
  if (a.is_json) {
    fmt::print("{}\n", json.dump(2));
  }
  if (a.output.empty()) {
    return {};
  }
  const std::string name = a.table.file == "-" ? "Results" : a.table.file.filename().string();
  return WritePage(a.output, pages::MakeHtmlPage(name + ": analysis",
                                                 "<h1>" + pages::Escape(name) + "</h1>" + html));
}

Result<void> Analyse(AnalyseArguments a) {
  if (!a.output.empty()) {
    if (auto checked = CheckPageFile(a.output, a.is_forced); !checked) {
      return checked;
    }
  }
  if (a.options.of && a.table.quantity.empty()) {
    a.table.quantity = fmt::format("right answers of {}", *a.options.of);
  }
  const auto table = ReadStudyTable(a.table);
  if (!table) {
    return Unexpected(table.error());
  }
  if (const auto* answers = std::get_if<std::vector<study::Answer>>(&table->content)) {
    const auto identification = study::AnalyseIdentification(*answers, a.options.alpha);
    if (!identification) {
      return Unexpected(identification.error());
    }
    if (!a.is_json) {
      PrintText(*identification);
    }
    return Show(a, ToJson(*identification, table->notes),
                study::IdentificationHtml(*identification));
  }
  auto analysis = study::Analyse(std::get<study::Table>(table->content), a.options);
  if (!analysis) {
    Error error = analysis.error();
    error.where = a.table.file.string() + (error.where.empty() ? "" : ", " + error.where);
    return Unexpected(error);
  }
  if (!a.is_json) {
    PrintText(*analysis, table->notes);
  }
  const nlohmann::ordered_json json = ToJson(*analysis, table->notes);
  analysis->notes.insert(analysis->notes.begin(), table->notes.begin(), table->notes.end());
  return Show(a, json, study::AnalysisHtml(*analysis));
}

}  // namespace

void AddStudyAnalyse(CLI::App* study, int* status) {
  CLI::App* command = study->add_subcommand(
      "analyse", "Tests, intervals, effect sizes and figures of a table of results");
  const auto a = std::make_shared<AnalyseArguments>();
  AddStudyTableOptions(command, &a->table)->required();
  command->add_option("--alpha", a->options.alpha, "Level of all comparisons together")
      ->capture_default_str();
  command->add_option("--of", a->options.of,
                      "Values are counts of right answers of so many trials");
  command->add_option("--chance", a->options.chance,
                      "Probability of a right answer by guessing; one in the number of conditions "
                      "without it");
  CLI::Option* higher = command->add_flag_callback(
      "--higher-is-better", [a] { a->options.direction = study::Direction::kHigherIsBetter; },
      "Say which of a pair is better; changes no test");
  command
      ->add_flag_callback(
          "--lower-is-better", [a] { a->options.direction = study::Direction::kLowerIsBetter; },
          "The same, for times and errors")
      ->excludes(higher);
  command->add_flag("--json", a->is_json, "Print one JSON document");
  command->add_option("-o,--output", a->output, "Write a page with figures, too: .html or .pdf");
  command->add_flag("--force", a->is_forced, "Replace a file that is there");
  command->footer(
      "Three conditions or more: Friedman's test. Pairs: Wilcoxon's signed ranks, asymptotic and\n"
      "exact, with Bonferroni and Holm. What is meant by each: docs/algorithms/statistics.md.\n"
      "Examples:\n"
      "  hvas study analyse --table data/studies/identification-2016.csv --of 15\n"
      "  hvas study analyse --table times.csv --quantity \"completion time\" --unit s "
      "--lower-is-better -o times.html\n"
      "  hvas study analyse --table trials.csv --value time_s --trials median --json\n"
      "  hvas study analyse --table answers.csv -o answers.pdf");
  command->callback([a, status] {
    const auto done = Analyse(*a);
    *status = done ? 0 : ReportFailure(done.error());
  });
}

}  // namespace hvas::app
