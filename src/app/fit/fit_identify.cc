#include "app/fit/fit_identify.h"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/rendering_options.h"
#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "study/identification.h"

namespace hvas::app {
namespace {

using study::IdentificationOptions;
using study::kPaperRight;
using study::kPaperTrials;
using study::kShownFitNames;
using study::kShownFits;
using study::ObserverResult;

constexpr const char* kWhat =
    "simulated: an observer with published thresholds of force, not people";

double CalcPaperShare(std::size_t fit) {
  return static_cast<double>(kPaperRight[fit]) / kPaperTrials;
}

nlohmann::ordered_json ToJson(const IdentificationOptions& options, const ObserverResult& result) {
  nlohmann::ordered_json json{{"schema", "hvas-fit-identify-1"},
                              {"what", kWhat},
                              {"force_map", haptics::ToString(options.map)},
                              {"trials", options.trials},
                              {"training", options.training},
                              {"seed", options.seed},
                              {"weber_fraction", options.observer.weber},
                              {"threshold_n", options.observer.threshold},
                              {"looks", options.observer.looks},
                              {"sizes", fits::ToString(options.pairs)}};
  for (int fit = 0; fit < kShownFits; ++fit) {
    const auto i = static_cast<std::size_t>(fit);
    const auto interval = study::CalcShareInterval(result.counts[i][i], options.trials);
    nlohmann::ordered_json answers;
    for (std::size_t j = 0; j < kShownFitNames.size(); ++j) {
      answers[kShownFitNames[j]] = result.counts[i][j];
    }
    json["fits"].push_back({{"shown", kShownFitNames[i]},
                            {"right_share", result.CalcShare(fit)},
                            {"right_share_95", {interval.low, interval.high}},
                            {"answers", answers},
                            {"felt_end_mean_n", result.mean_felt[i]},
                            {"felt_end_sigma_n", result.sigma_felt[i]},
                            {"paper_right_share", CalcPaperShare(i)}});
  }
  return json;
}

void PrintText(const IdentificationOptions& options, const ObserverResult& result) {
  fmt::print("{}", Fold(fmt::format("{}\n{} insertions of each fit, force map: {}, sizes: {}\n\n",
                                    kWhat, options.trials, haptics::ToString(options.map),
                                    fits::ToString(options.pairs))));
  TextTable table({"shown\n", "right\n%", "95 %\nof right", "as g6\n", "as p6\n", "as k6\n",
                   "felt at end\nN", "right in\npaper W, %"});
  for (int fit = 0; fit < kShownFits; ++fit) {
    const auto i = static_cast<std::size_t>(fit);
    const auto interval = study::CalcShareInterval(result.counts[i][i], options.trials);
    table.Add({kShownFitNames[i], fmt::format("{:.1f}", 100 * result.CalcShare(fit)),
               fmt::format("{:.1f} to {:.1f}", 100 * interval.low, 100 * interval.high),
               fmt::format("{}", result.counts[i][0]), fmt::format("{}", result.counts[i][1]),
               fmt::format("{}", result.counts[i][2]),
               fmt::format("{:.2f} +- {:.2f}", result.mean_felt[i], result.sigma_felt[i]),
               fmt::format("{:.1f}", 100 * CalcPaperShare(i))});
  }
  fmt::print("{}", table.ToText());
}

int Run(const IdentificationOptions& options, bool is_json) {
  const auto result = [&options] {
    const Busy busy("inserting and answering");
    return study::Identify(options);
  }();
  if (!result) {
    return ReportFailure(result.error());
  }
  if (is_json) {
    fmt::print("{}\n", ToJson(options, *result).dump(2));
  } else {
    PrintText(options, *result);
  }
  return 0;
}

}  // namespace

void AddFitIdentify(CLI::App* fit, int* status) {
  CLI::App* command = fit->add_subcommand(
      "identify", "Test with a simulated observer whether fits can be identified by feel");
  const auto options = std::make_shared<IdentificationOptions>();
  const auto is_json = std::make_shared<bool>(false);
  command->add_option("--trials", options->trials, "Test insertions of each fit")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--training", options->training, "Training insertions of each fit")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed for sizes, surfaces and noise")
      ->capture_default_str();
  command
      ->add_option("--weber", options->observer.weber,
                   "Just noticeable difference (Weber fraction) of force")
      ->check(FromBelow(0, 1))
      ->capture_default_str();
  command->add_option("--threshold", options->observer.threshold, "Absolute threshold of force [N]")
      ->check(Positive())
      ->capture_default_str();
  command->add_option("--looks", options->observer.looks, "Perceptions in one insertion")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  AddPairsOption(command, &options->pairs);
  AddForceMapOption(command, &options->map);
  AddJsonFlag(command, is_json.get(), "fit_identify");
  command->footer(
      "The three fits of paper W are presented blind; the observer answers with the nearest of "
      "three\n"
      "learned curves of felt force over depth. Fits that it cannot tell apart, people cannot "
      "either;\n"
      "fits that it can, people may.");
  command->callback([options, is_json, status] { *status = Run(*options, *is_json); });
}

}  // namespace hvas::app
