#include "app/study/study_power.h"

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/study/study_table.h"
#include "statistics/power.h"

namespace hvas::app {
namespace {

using statistics::Design;
using statistics::PowerPoint;
using statistics::PowerResult;
using statistics::PowerTest;

struct PowerArguments {
  StudyTableOptions table;
  std::vector<double> means;
  std::vector<double> sds;
  std::vector<double> medians;
  std::vector<double> log_sds;
  std::vector<double> shares;
  int of{0};
  double correlation{0.5};
  int comparisons{1};
  std::optional<int> participants;
  statistics::PowerOptions options;
  bool is_json{false};
};

/** One spread stands for all conditions. */
std::vector<double> Spread(const std::vector<double>& spreads, std::size_t count) {
  return spreads.size() == 1 ? std::vector<double>(count, spreads[0]) : spreads;
}

Result<Design> MakePilot(const StudyTableOptions& options) {
  const auto read = ReadStudyTable(options);
  if (!read) {
    return Unexpected(read.error());
  }
  const auto* table = std::get_if<study::Table>(&read->content);
  if (table == nullptr) {
    return Fail(ErrorCode::kInvalid, "a table of answers cannot be used as a pilot study",
                options.file.string(), "give the shares of correct answers with --identification");
  }
  statistics::PilotDesign design;
  for (const study::Row& row : table->rows) {
    std::vector<double> values;
    for (const std::optional<double>& value : row.values) {
      if (value) {
        values.push_back(*value);
      }
    }
    if (values.size() == row.values.size()) {
      design.rows.push_back(std::move(values));
    }
  }
  return design;
}

Result<Design> MakeDesign(const PowerArguments& a) {
  const int given = (a.means.empty() ? 0 : 1) + (a.medians.empty() ? 0 : 1) +
                    (a.shares.empty() ? 0 : 1) + (a.table.file.empty() ? 0 : 1);
  if (given != 1) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} designs are given", given), "design",
                "give one of --means, --medians, --identification and --table");
  }
  if (!a.means.empty()) {
    return statistics::NormalDesign{a.means, Spread(a.sds, a.means.size()), a.correlation};
  }
  if (!a.medians.empty()) {
    return statistics::LogNormalDesign{a.medians, Spread(a.log_sds, a.medians.size()),
                                       a.correlation};
  }
  if (!a.shares.empty()) {
    return statistics::CountDesign{a.shares, a.of};
  }
  return MakePilot(a.table);
}

const char* ToText(PowerTest test) {
  return test == PowerTest::kFriedman ? "friedman" : "wilcoxon";
}

nlohmann::ordered_json ToJson(const PowerArguments& a, const Design& design,
                              const PowerResult& result) {
  nlohmann::ordered_json json{{"schema", "hvas-study-power-1"},
                              {"test", ToText(a.options.test)},
                              {"conditions", statistics::CountConditions(design)},
                              {"level", a.options.alpha},
                              {"target_power", a.options.target},
                              {"runs", a.options.runs},
                              {"seed", a.options.seed},
                              {"participants", nullptr},
                              {"points", nlohmann::ordered_json::array()}};
  if (result.participants) {
    json["participants"] = *result.participants;
  }
  for (const PowerPoint& point : result.points) {
    json["points"].push_back({{"participants", point.participants},
                              {"power", point.power.share},
                              {"monte_carlo_error", point.monte_carlo_error},
                              {"power_ci", {point.power.ci.low, point.power.ci.high}}});
  }
  return json;
}

void PrintText(const PowerArguments& a, const Design& design, const PowerResult& result) {
  fmt::print("{}\n", Fold(fmt::format(
                         "{} test of {} conditions at level {:.4g}: {} simulated studies of each "
                         "size, seed {}\n",
                         a.options.test == PowerTest::kFriedman ? "Friedman" : "Wilcoxon",
                         statistics::CountConditions(design), a.options.alpha, a.options.runs,
                         a.options.seed)));
  fmt::print("{:>12}{:>9}{:>14}{:>18}\n", "participants", "power", "Monte Carlo", "95 % of power");
  for (const PowerPoint& point : result.points) {
    fmt::print("{:>12}{:>9.4f}{:>14}{:>18}\n", point.participants, point.power.share,
               fmt::format("+- {:.4f}", point.monte_carlo_error),
               fmt::format("{:.4f} to {:.4f}", point.power.ci.low, point.power.ci.high));
  }
  if (a.participants) {
    return;
  }
  if (result.participants) {
    fmt::print("\n{}",
               Wrap(fmt::format("{} participants reach a power of {:g}. If the interval of one "
                                "fewer reaches it, too, increase --runs to separate them.",
                                *result.participants, a.options.target),
                    0));
  } else {
    fmt::print("\n{}", Wrap(fmt::format("Up to {} participants do not reach a power of {:g}: "
                                        "increase --most, or the difference to detect.",
                                        a.options.most, a.options.target),
                            0));
  }
}

Result<void> Simulate(PowerArguments a) {
  if (a.comparisons < 1) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} comparisons", a.comparisons), "--comparisons",
                "give at least 1");
  }
  a.options.alpha /= a.comparisons;
  const auto design = MakeDesign(a);
  if (!design) {
    return Unexpected(design.error());
  }
  statistics::PowerProgress progress;
  if (IsWatched()) {
    progress = [](int participants, double fraction) {
      ShowProgress(fmt::format("studies of {} participants", participants), fraction);
    };
  }
  PowerResult result;
  if (a.participants) {
    a.options.most = std::max(a.options.most, *a.participants);
    const auto point = statistics::EstimatePower(*design, a.options, *a.participants, progress);
    if (!point) {
      return Unexpected(point.error());
    }
    result.points.push_back(*point);
    if (point->power.share >= a.options.target) {
      result.participants = point->participants;
    }
  } else {
    auto found = statistics::FindSampleSize(*design, a.options, progress);
    if (!found) {
      return Unexpected(found.error());
    }
    result = *std::move(found);
  }
  if (IsWatched()) {
    ShowProgress("", 1);
  }
  if (a.is_json) {
    fmt::print("{}\n", ToJson(a, *design, result).dump(2));
  } else {
    PrintText(a, *design, result);
  }
  return {};
}

void AddDesignOptions(CLI::App* command, PowerArguments* a) {
  const char* const group = "Design";
  const auto add = [&](const char* name, std::vector<double>* values, const CLI::Validator& range,
                       const char* what) {
    return command->add_option(name, *values, what)->delimiter(',')->check(range)->group(group);
  };
  CLI::Option* means =
      add("--means", &a->means, AnyNumber(), "Means of the conditions; normal distribution");
  CLI::Option* sds =
      add("--sd", &a->sds, Positive(),
          "Standard deviation between participants: one for all conditions, or one for each");
  CLI::Option* medians = add("--medians", &a->medians, Positive(),
                             "Medians of the conditions; log-normal distribution, as of times");
  CLI::Option* log_sds = add("--log-sd", &a->log_sds, Positive(),
                             "Standard deviation of the natural logarithm: 0.3 is about 30 %");
  CLI::Option* shares = add("--identification", &a->shares, CLI::Range(0.0, 1.0),
                            "Probability of a correct answer under each condition");
  CLI::Option* of = command->add_option("--of", a->of, "Trials for each condition")
                        ->check(CLI::Range(1, 10'000))
                        ->group(group);
  command
      ->add_option(
          "--correlation", a->correlation,
          "Correlation of a participant's values under two conditions, with --means and --medians")
      ->check(FromBelow(0, 1))
      ->capture_default_str()
      ->group(group);
  means->needs(sds);
  sds->needs(means);
  medians->needs(log_sds);
  log_sds->needs(medians);
  shares->needs(of);
  of->needs(shares);
}

}  // namespace

void AddStudyPower(CLI::App* study, int* status) {
  CLI::App* command = study->add_subcommand(
      "power", "Find the number of participants that a design needs, by simulation");
  const auto a = std::make_shared<PowerArguments>();
  AddDesignOptions(command, a.get());
  AddStudyTableOptions(command, &a->table);
  const Choices<PowerTest> tests{{"friedman", PowerTest::kFriedman},
                                 {"wilcoxon", PowerTest::kWilcoxon}};
  AddChoice(command, "--test", &a->options.test, tests,
            "Test: friedman, or wilcoxon for two conditions; asymptotic")
      ->default_str("friedman");
  command->add_option("--alpha", a->options.alpha, "Family-wise significance level")
      ->check(Between(0, 0.5))
      ->capture_default_str();
  command
      ->add_option(
          "--comparisons", a->comparisons,
          "Number of tests that share the level (Bonferroni): 3 for the pairs of three conditions")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command
      ->add_option("--power", a->options.target,
                   "Required power: share of studies that find a difference")
      ->check(Between(0, 1))
      ->capture_default_str();
  command
      ->add_option("--participants", a->participants,
                   "Only calculate the power with this number of participants")
      ->check(CLI::Range(3, 10'000));
  command->add_option("--most", a->options.most, "Largest number of participants to try")
      ->check(CLI::Range(3, 10'000))
      ->capture_default_str();
  command->add_option("--runs", a->options.runs, "Number of simulated studies for each size")
      ->check(CLI::Range(100, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", a->options.seed, "Seed of the simulation")->capture_default_str();
  AddJsonFlag(command, &a->is_json, "study_power");
  command->footer(
      "The table is a pilot study in the format of `hvas study analyse`; its complete participants "
      "are\n"
      "resampled with replacement.\n"
      "Examples:\n"
      "  hvas study power --means 12.6,9.4 --sd 4 --correlation 0.5 --test wilcoxon\n"
      "  hvas study power --medians 29.8,12.6,9.4 --log-sd 0.4 --power 0.9\n"
      "  hvas study power --identification 0.911,0.804,0.773 --of 15\n"
      "  hvas study power --table data/studies/identification-2016.csv --columns B1,B2 --test "
      "wilcoxon --comparisons 3");
  command->callback([a, status] {
    const auto done = Simulate(*a);
    *status = done ? 0 : ReportFailure(done.error());
  });
}

}  // namespace hvas::app
