#include "app/study/study_analyse.h"

#include <algorithm>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/recording/page_file.h"
#include "app/study/study_json.h"
#include "app/study/study_table.h"
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

void PrintConditions(const study::Analysis& analysis) {
  const std::string level = fmt::format("{:g} %", 100 * (1 - analysis.options.alpha));
  TextTable table({"condition\n", "n\n", "mean\n", level + "\nof mean", "SD\n", "least\n",
                   "lower\nquartile", "median\n", "upper\nquartile", "largest\n"});
  for (const study::ConditionResult& condition : analysis.conditions) {
    const statistics::Summary& s = condition.summary;
    table.Add({condition.name, fmt::format("{}", s.n), Format(s.mean), Format(s.mean_ci),
               Format(s.sd), Format(s.min), Format(s.lower_quartile), Format(s.median),
               Format(s.upper_quartile), Format(s.max)});
  }
  fmt::print("{}", table.ToText());
  if (!analysis.options.of) {
    return;
  }
  TextTable shares({"right answers\n", "right\n", "trials\n", "share\n%", level + " of share\n%",
                    fmt::format("p against\n{:.3g} %", 100 * analysis.chance)});
  for (const study::ConditionResult& condition : analysis.conditions) {
    const statistics::Share& share = *condition.share;
    shares.Add({condition.name, fmt::format("{}", share.right), fmt::format("{}", share.trials),
                fmt::format("{:.1f}", 100 * share.share),
                fmt::format("{:.1f} to {:.1f}", 100 * share.ci.low, 100 * share.ci.high),
                FormatP(share.chance_p)});
  }
  fmt::print("\n{}", shares.ToText());
}

std::string PairName(const study::Analysis& analysis, const study::PairResult& pair) {
  return analysis.table.conditions[pair.first] + " - " + analysis.table.conditions[pair.second];
}

void PrintPairs(const study::Analysis& analysis) {
  TextTable tests({"Wilcoxon\n", "n\n", "zero\n", "Z\n", "p\n", "p by\nBonferroni", "p by\nHolm",
                   "exact\np", "exact by\nBonferroni", "exact by\nHolm"});
  for (const study::PairResult& pair : analysis.pairs) {
    const statistics::Wilcoxon& w = pair.wilcoxon;
    tests.Add({PairName(analysis, pair), fmt::format("{}", w.n), fmt::format("{}", w.zero_count),
               Format(w.z), FormatP(w.p), FormatP(pair.bonferroni_p), FormatP(pair.holm_p),
               FormatP(w.exact_p), FormatP(pair.exact_bonferroni_p), FormatP(pair.exact_holm_p)},
              study::DescribePair(analysis, pair));
  }
  TextTable variants({"Wilcoxon, variants\n", "with continuity\np", "Pratt\nZ", "Pratt\np"});
  for (const study::PairResult& pair : analysis.pairs) {
    const statistics::Wilcoxon& w = pair.wilcoxon;
    variants.Add(
        {PairName(analysis, pair), FormatP(w.continuity_p), Format(w.pratt_z), FormatP(w.pratt_p)});
  }
  const std::string level = fmt::format("{:g} %", 100 * (1 - analysis.options.alpha));
  TextTable effects({"second - first\n", "mean\n", level + "\nof mean", "median\n", "per\ncent",
                     "d_z\n", level + "\nof d_z", "biserial\n", "Z/rt(n)\n"});
  for (const study::PairResult& pair : analysis.pairs) {
    const statistics::Summary& s = pair.difference.summary;
    std::optional<double> d_z;
    std::optional<statistics::Interval> d_z_ci;
    if (pair.d_z) {
      d_z = pair.d_z->d_z;
      d_z_ci = pair.d_z->ci;
    }
    effects.Add({PairName(analysis, pair), Format(s.mean), Format(s.mean_ci), Format(s.median),
                 Format(pair.difference.percent), Format(d_z), Format(d_z_ci),
                 Format(pair.wilcoxon.rank_biserial), Format(pair.wilcoxon.r)});
  }
  fmt::print("\n{}\n{}\n{}", tests.ToText(), variants.ToText(), effects.ToText());
}

void PrintParagraphs(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    fmt::print("{}", Wrap(text, 0));
  }
}

void PrintText(const study::Analysis& analysis, const std::vector<std::string>& notes) {
  const study::Table& table = analysis.table;
  fmt::print("{}\n", Fold(fmt::format("{}{}, {} participants, {} conditions\n", table.quantity,
                                      table.unit.empty() ? "" : fmt::format(" [{}]", table.unit),
                                      table.rows.size(), table.conditions.size())));
  PrintConditions(analysis);
  const std::string told = study::DescribeFriedman(analysis);
  if (!told.empty()) {
    fmt::print("\n{}", Wrap(told, 0));
  }
  PrintPairs(analysis);
  fmt::print("\n");
  PrintParagraphs(notes);
  PrintParagraphs(analysis.notes);
  PrintParagraphs(study::DescribeConventions(analysis));
}

void PrintText(const study::Identification& identification) {
  const statistics::Confusion& confusion = identification.confusion;
  std::vector<std::string> heads{"shown \\ answered\n"};
  for (const std::string& answered : identification.names) {
    heads.push_back(Shorten(answered, 11) + "\n");
  }
  heads.emplace_back("right\n%");
  heads.push_back(fmt::format("{:g} %\nof share, %", 100 * identification.confidence));
  TextTable table(heads);
  const auto tell = [](const statistics::Share& share, std::vector<std::string>* cells) {
    cells->push_back(fmt::format("{:.1f}", 100 * share.share));
    cells->push_back(fmt::format("{:.1f} to {:.1f}", 100 * share.ci.low, 100 * share.ci.high));
  };
  for (std::size_t i = 0; i < identification.names.size(); ++i) {
    std::vector<std::string> cells{identification.names[i]};
    for (const std::int64_t count : confusion.counts[i]) {
      cells.push_back(fmt::format("{}", count));
    }
    if (confusion.recall[i]) {
      tell(*confusion.recall[i], &cells);
    }
    table.Add(std::move(cells));
  }
  std::vector<std::string> all{"all"};
  all.resize(1 + identification.names.size());
  tell(confusion.accuracy, &all);
  table.Add(std::move(all));
  std::string text = fmt::format(
      "{} answers of {} participants\n\n{}\nCohen's kappa {}", confusion.accuracy.trials,
      identification.participant_count, table.ToText(),
      confusion.kappa ? fmt::format("{:.4f}", *confusion.kappa) : std::string("is not defined"));
  if (identification.chance) {
    text += fmt::format("; p against chance ({:.3g} %) {}", 100 * *identification.chance,
                        FormatP(confusion.accuracy.chance_p));
  }
  fmt::print("{}", Fold(text + "\n"
                               "Intervals by Clopper and Pearson; all answers count as "
                               "independent, also those of one participant.\n"));
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
    a.table.quantity = fmt::format("correct answers of {}", *a.options.of);
  }
  const auto table = ReadStudyTable(a.table);
  if (!table) {
    return Unexpected(table.error());
  }
  if (const auto* answers =
          std::get_if<std::vector<study::IdentificationAnswer>>(&table->content)) {
    const auto identification = study::AnalyseIdentification(*answers, a.options.alpha);
    if (!identification) {
      return Unexpected(identification.error());
    }
    if (!a.is_json) {
      PrintText(*identification);
    }
    return Show(a, ToJson(*identification, table->notes),
                study::MakeIdentificationHtml(*identification));
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
  return Show(a, json, study::MakeAnalysisHtml(*analysis));
}

}  // namespace

void AddStudyAnalyse(CLI::App* study, int* status) {
  CLI::App* command = study->add_subcommand(
      "analyse", "Analyse a table of results: tests, intervals, effect sizes and figures");
  const auto a = std::make_shared<AnalyseArguments>();
  AddStudyTableOptions(command, &a->table)->required();
  command->add_option("--alpha", a->options.alpha, "Family-wise significance level")
      ->check(Between(0, 0.5))
      ->capture_default_str();
  command
      ->add_option("--of", a->options.of,
                   "Number of trials for each value, when values are counts of correct answers")
      ->check(CLI::Range(1, 10'000));
  command
      ->add_option(
          "--chance", a->options.chance,
          "Probability of a correct answer by guessing; default: one over the number of conditions")
      ->check(Between(0, 1));
  CLI::Option* higher = command->add_flag_callback(
      "--higher-is-better", [a] { a->options.direction = study::Direction::kHigherIsBetter; },
      "Higher values are better: name the better of a pair; does not affect tests");
  command
      ->add_flag_callback(
          "--lower-is-better", [a] { a->options.direction = study::Direction::kLowerIsBetter; },
          "Lower values are better, as for times and errors")
      ->excludes(higher);
  AddJsonFlag(command, &a->is_json, "study_analysis or study_identification");
  command->add_option("-o,--output", a->output, "Also write a page with figures: .html or .pdf");
  command->add_flag("--force", a->is_forced, "Replace an existing file");
  command->footer(
      "Three conditions or more: Friedman test. Pairs: Wilcoxon signed-rank test, asymptotic and\n"
      "exact, adjusted by Bonferroni and Holm. Definitions: docs/algorithms/statistics.md.\n"
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
