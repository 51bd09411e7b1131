#include "app/recording/replay.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <tuple>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/rendering_options.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "session/replay.h"

namespace hvas::app {
namespace {

using session::ReplayedPart;
using session::ReplayReport;
using simulation::Model;

// The exit status: the record says otherwise.
constexpr int kDifferent = 2;

/** What a replay has found out. */
struct Outcome {
  ReplayReport report;
  std::string damage;  ///< What of the record is not as it was written; empty: nothing.

  [[nodiscard]] bool is_exact() const { return damage.empty() && report.is_exact(); }
};

double Seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

double CalcSpeed(const ReplayReport& report) {
  return static_cast<double>(report.session_ns) /
         static_cast<double>(std::max<std::int64_t>(1, report.wall_ns));
}

const std::string& PathOfReplayed(const Model& model, const ReplayedPart& part) {
  return model.product->occurrences[part.occurrence.index()].path;
}

nlohmann::ordered_json MakeOutcomeJson(const ReplayedPart::Outcome& outcome) {
  return {{"peak_true_n", outcome.peak_true},
          {"peak_felt_n", outcome.peak_felt},
          {"insertion_m", outcome.depth},
          {"seated", outcome.is_seated}};
}

void PrintReplayJson(const Model& model, const record::Reader& reader, const Outcome& outcome) {
  const ReplayReport& report = outcome.report;
  nlohmann::ordered_json json{{"product", model.product->name},
                              {"complete", reader.is_complete()},
                              {"exact", outcome.is_exact()},
                              {"stretches", report.stretches},
                              {"ticks", report.ticks},
                              {"different_ticks", report.different_ticks},
                              {"unreachable_ticks", report.unreachable_ticks},
                              {"largest_felt_difference_n", report.largest_felt_difference},
                              {"rms_felt_difference_n", report.rms_felt_difference},
                              {"largest_way_m", report.largest_way},
                              {"session_s", Seconds(report.session_ns)},
                              {"wall_s", Seconds(report.wall_ns)},
                              {"real_time_factor", CalcSpeed(report)}};
  if (!outcome.damage.empty()) {
    json["damage"] = outcome.damage;
  }
  if (report.first) {
    json["first_difference"] = {{"time_s", Seconds(report.first->t_ns)},
                                {"hand", report.first->hand},
                                {"what", report.first->field}};
  }
  nlohmann::ordered_json& parts = json["parts"] = nlohmann::ordered_json::array();
  for (const ReplayedPart& part : report.parts) {
    parts.push_back({{"occurrence", part.occurrence.value()},
                     {"path", PathOfReplayed(model, part)},
                     {"held_s", Seconds(part.held_ns)},
                     {"recorded", MakeOutcomeJson(part.recorded)},
                     {"replayed", MakeOutcomeJson(part.replayed)}});
  }
  fmt::print("{}\n", json.dump(2));
}

void PrintParts(const Model& model, const ReplayReport& report) {
  TextTable table({"part", "true, recorded\nN", "replayed\nN", "felt, recorded\nN", "replayed\nN",
                   "depth, recorded\nmm", "replayed\nmm", "in place\nrecorded", "\nreplayed"});
  const auto both = [](double recorded, double replayed) {
    return std::array{fmt::format("{:.2f}", recorded), fmt::format("{:.2f}", replayed)};
  };
  const auto place = [](const ReplayedPart::Outcome& outcome) {
    return std::string(outcome.is_seated ? "yes" : "no");
  };
  for (const ReplayedPart& part : report.parts) {
    const auto& [before, after] = std::tie(part.recorded, part.replayed);
    const auto peak = both(before.peak_true, after.peak_true);
    const auto felt = both(before.peak_felt, after.peak_felt);
    const auto depth = both(units::ToMm(before.depth), units::ToMm(after.depth));
    table.Add({PathOfReplayed(model, part), peak[0], peak[1], felt[0], felt[1], depth[0], depth[1],
               place(before), place(after)});
  }
  fmt::print("\n{}", table.ToText());
}

void PrintText(const Model& model, const record::Reader& reader, const Outcome& outcome) {
  const ReplayReport& report = outcome.report;
  std::string text = fmt::format(
      "{}: {} ticks of {:.1f} s in {} stretch{} run again in {:.2f} s, {:.0f} times as fast\n",
      model.product->name, report.ticks, Seconds(report.session_ns), report.stretches,
      report.stretches == 1 ? "" : "es", Seconds(report.wall_ns), CalcSpeed(report));
  if (!reader.is_complete()) {
    text += "The record is incomplete: the session was interrupted, or is still running.\n";
  }
  if (report.ticks == 0) {
    text += "The record has no tick that can be replayed: nothing was verified.\n";
  } else if (report.is_exact()) {
    text += fmt::format("Every wrench and pose {} is the recorded one, bit for bit.\n",
                        outcome.damage.empty() ? "of the session" : "that the record still has");
  } else if (report.unreachable_ticks > 0) {
    text += fmt::format("{} ticks could not be replayed: the record lacks ticks before them.\n",
                        report.unreachable_ticks);
  }
  if (report.first) {
    text += fmt::format(
        "{} of them differ, the first one at {:.3f} s (hand {}): {}.\n"
        "Felt force: {:.3g} N apart at most, {:.3g} N rms; parts: {:.3g} mm at most.\n",
        report.different_ticks, Seconds(report.first->t_ns), report.first->hand,
        report.first->field, report.largest_felt_difference, report.rms_felt_difference,
        units::ToMm(report.largest_way));
  }
  fmt::print("{}", Fold(text));
  if (report.first) {
    PrintParts(model, report);
  }
}

}  // namespace

int RunReplay(const ReplayArguments& arguments) {
  auto reader = record::Reader::Open(arguments.record.file);
  if (!reader) {
    return ReportFailure(reader.error());
  }
  Outcome outcome;
  if (const auto verified = reader->Verify(); !verified) {
    outcome.damage = verified.error().message;
    if (!arguments.is_json) {
      static_cast<void>(ReportFailure(verified.error()));
    }
  }
  const auto model = PrepareModel(&*reader, arguments.record);
  if (!model) {
    return ReportFailure(model.error());
  }
  session::ReplayOptions options;
  options.condition = arguments.condition;
  options.force_map = arguments.force_map;
  if (!arguments.record.is_quiet && IsWatched()) {
    options.progress = [](double fraction) { ShowProgress("replay", fraction); };
  }
  auto report = session::Replay(&*reader, *model, options);
  if (options.progress != nullptr) {
    ShowProgress("", 1);
  }
  if (!report) {
    return ReportFailure(report.error());
  }
  outcome.report = std::move(*report);
  if (arguments.is_json) {
    PrintReplayJson(**model, *reader, outcome);
  } else {
    PrintText(**model, *reader, outcome);
  }
  return arguments.is_verified && !outcome.is_exact() ? kDifferent : 0;
}

void AddReplay(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "replay", "Replay a recorded session and compare every wrench with the record");
  const auto arguments = std::make_shared<ReplayArguments>();
  AddRecordOptions(command, &arguments->record);
  CLI::Option* verify = command->add_flag(
      "--verify", arguments->is_verified,
      "Exit with status 2 unless the record is unchanged and the replay equals it bit for bit");
  AddConditionOption(command, &arguments->condition)
      ->description(
          "Render the recorded motion under this condition instead: collision, constraint or "
          "hybrid")
      ->excludes(verify);
  AddForceMapOption(command, &arguments->force_map)->excludes(verify);
  AddJsonFlag(command, &arguments->is_json, "replay");
  command->footer(
      "Exit status: 0; 2 when --verify found a difference, lost ticks, a change\n"
      "in the record after it was written, or nothing to compare; 1 on an error.\n"
      "With another condition or force map the hand moves as recorded: it does not react to the "
      "new forces.\n"
      "Examples:\n"
      "  hvas replay press.hvasrec --verify\n"
      "  hvas replay press.hvasrec --force-map paper\n"
      "  hvas replay press.hvasrec --condition collision --json | jq '.parts[].replayed'");
  command->callback([arguments, status] { *status = RunReplay(*arguments); });
}

}  // namespace hvas::app
