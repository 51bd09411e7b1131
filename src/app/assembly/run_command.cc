#include "app/assembly/run_command.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/assembly/plan_file.h"
#include "app/assembly/rendering_options.h"
#include "app/assembly/run_report.h"
#include "app/command_watch.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "assembly/explain_gaps.h"
#include "assembly/prepare_model.h"
#include "base/clock.h"
#include "base/crash_note.h"
#include "record/recorder.h"

namespace hvas::app {
namespace {

using simulation::Model;
using simulation::PartResult;

Result<std::shared_ptr<const Model>> MakeModel(const RunCommandOptions& options,
                                               const OrderChoice& order,
                                               const std::stop_token& stop,
                                               PreparationProgress* progress,
                                               Diagnostics* diagnostics) {
  const cad::ProgressFn note = [progress, is_shown = IsShown(options)](std::string_view stage,
                                                                       double fraction) {
    if (fraction < 1) {  // A stage also ends so where it was stopped.
      progress->stage = stage;
      progress->fraction = fraction;
    }
    NoteStage(stage);
    if (is_shown) {
      ShowProgress(stage, fraction);
    }
  };
  LoadOptions load = options.load;
  load.stop = stop;
  load.progress = note;
  auto product = LoadProduct(load, diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  for (const product::Occurrence& occurrence : product->occurrences) {
    progress->parts.push_back(occurrence.path);
  }
  assembly::PrepareOptions prepare;
  prepare.seed = options.run.seed;
  prepare.pairs = options.pairs;
  prepare.first_parts = order.first_parts;
  prepare.base = order.base;
  prepare.is_thorough = order.is_thorough;
  if (!order.plan.empty()) {
    auto steps = ReadPlan(order.plan, *product);
    if (!steps) {
      return Unexpected(steps.error());
    }
    prepare.steps = std::move(*steps);
  }
  CommandWatch::Get().AllowLongWork();
  prepare.shape_cache = assembly::MakeShapeCache(CacheDirectory(options.load));
  prepare.stop = stop;
  prepare.progress = note;
  auto model = assembly::PrepareModel(std::move(*product), prepare, diagnostics);
  if (!model) {
    return model;
  }
  if (const auto strict = CheckStrict(options.load, *diagnostics); !strict) {
    return Unexpected(strict.error());
  }
  return model;
}

/** Prints how forces are rendered with each device. */
void ShowNotes(const std::vector<assembly::DeviceInHand>& devices) {
  for (const assembly::DeviceInHand& device : devices) {
    const std::string whose = devices.size() == 1 ? "" : NameOfHand(device.hand);
    for (const std::string& note : device.notes) {
      fmt::print(stderr, "hvas: {}{}{}: {}\n", whose, devices.size() == 1 ? "" : ": ", device.model,
                 note);
    }
  }
}

void ShowPart(const Model& model, const TurnWords& words, std::int64_t start_ns,
              const simulation::AssemblyProgress& progress, const PartResult& part) {
  const auto wall_ns = static_cast<double>(std::max<std::int64_t>(1, MonotonicNs() - start_ns));
  ShowProgress(
      fmt::format("part {} of {}, {} {}, {:.1f} x real time; {}{},", progress.tried, progress.total,
                  progress.done, words.done, static_cast<double>(progress.t_ns) / wall_ns,
                  words.is_done(part) ? "" : words.failed,
                  Shorten(model.product->occurrences[part.occurrence.index()].path, 40)),
      static_cast<double>(progress.tried) / static_cast<double>(progress.total));
}

}  // namespace

bool IsShown(const RunCommandOptions& options) {
  return !options.load.is_quiet && IsWatched();
}

Result<std::shared_ptr<const Model>> PrepareRun(const RunCommandOptions& options,
                                                const OrderChoice& order,
                                                const std::stop_token& stop,
                                                PreparationProgress* progress) {
  if (!options.run.record.empty()) {
    const auto target = record::CheckTarget(options.run.record, options.run.is_record_replaced);
    if (!target) {
      return Unexpected(target.error());
    }
  }
  Diagnostics diagnostics;
  progress->start_ns = MonotonicNs();
  auto model = MakeModel(options, order, stop, progress, &diagnostics);
  if (!model) {
    return model;
  }
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "shape-cache" || item.code == "cache-unwritable" ||
        item.code.starts_with("limit-") || item.code.starts_with("mate-")) {
      fmt::print(stderr, "hvas: {}: {}{}\n", item.entity, item.message,
                 item.remedy.empty() ? "" : " (" + item.remedy + ")");
    }
  }
  return model;
}

int ReportUnprepared(const RunCommandOptions& options, const PreparationProgress& progress,
                     const Error& cause) {
  const Error error = CommandWatch::Get().Translate(cause);
  const bool is_ended =
      error.code == ErrorCode::kCancelled || error.code == ErrorCode::kOutOfResource;
  if (options.is_json && is_ended) {
    nlohmann::ordered_json json{
        {"source", options.load.file.filename().string()},
        {"reason", error.message},
        {"stage", progress.stage},
        {"stage_fraction", progress.fraction},
        {"preparation_s", 1e-9 * static_cast<double>(MonotonicNs() - progress.start_ns)}};
    json["parts"] = nlohmann::ordered_json::array();
    for (const std::string& name : progress.parts) {
      json["parts"].push_back({{"name", name},
                               {"seated", false},
                               {"is_assumed", false},
                               {"reason", "the preparation ended before its turn"}});
    }
    PrintJson(json);
  }
  return ReportFailure(error);
}

assembly::RunOptions MakeRunOptions(const RunCommandOptions& options,
                                    const std::shared_ptr<const Model>& model,
                                    const TurnWords& words) {
  assembly::RunOptions run = options.run;
  run.devices = {options.device};
  if (run.is_realtime || !options.device.empty()) {
    CommandWatch::Get().End();
  }
  NoteStage(words.run);
  if (IsShown(options)) {
    run.on_begin = ShowNotes;
    run.on_part = [model, words, start_ns = MonotonicNs()](const auto& progress,
                                                           const PartResult& part) {
      ShowPart(*model, words, start_ns, progress, part);
    };
  }
  run.on_record_error = [name = words.run](const Error& error) {
    fmt::print(stderr, "\nhvas: {} (the {} continues)\n", error.ToString(), name);
  };
  return run;
}

SessionReport MakeSessionReport(const RunCommandOptions& options, assembly::RunOutcome outcome,
                                std::int64_t preparation_ns) {
  SessionReport report;
  report.run = std::move(outcome);
  report.preparation_ns = preparation_ns;
  report.seed = options.run.seed;
  report.is_realtime = options.run.is_realtime;
  report.force_map = options.run.force_map;
  return report;
}

void AddReasonsOption(CLI::App* command, double* reasons_s) {
  constexpr double kReasonsTime = 60;  // [s]: a person waits that long. A choice.
  *reasons_s = kReasonsTime;
  command
      ->add_option("--reasons", *reasons_s,
                   "How long is looked into why parts have no way in, of ten parts at most [s]; 0: "
                   "not at all")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
}

std::vector<orders::GapReason> ExplainLeftOut(const Model& model, double time_s, bool is_quiet,
                                              const std::stop_token& stop) {
  if (model.sequence.gaps.empty() || time_s == 0) {
    return {};
  }
  constexpr const char* kStage = "why parts have no way in";
  const bool is_shown = !is_quiet && IsWatched();
  assembly::ExplainGapsOptions options;
  options.time = std::chrono::duration<double>(time_s);
  options.stop = stop;
  NoteStage(kStage);
  if (is_shown) {
    options.progress = [](double fraction) { ShowProgress(kStage, fraction); };
  }
  auto reasons = assembly::ExplainGaps(model, options);
  if (is_shown) {
    ShowProgress(kStage, 1);
  }
  return reasons;
}

void AddOrderChoice(CLI::App* command, OrderChoice* order) {
  command->add_flag("--thorough", order->is_thorough,
                    "Search ten times as long for ways out where parts do not come out straight, "
                    "minutes instead of half a minute for a product");
  command->add_option("--base", order->base,
                      "The part that stays in the fixture, by name, path or id (o12); without it, "
                      "the largest part, or the one that most others are joined to");
}

void AddFitAndDeviceOptions(CLI::App* command, RunCommandOptions* options) {
  command
      ->add_option("--seed", options->run.seed,
                   "Seed for the person's motion and the parts' actual sizes")
      ->capture_default_str();
  command->add_option("--fit", options->load.fits,
                      "Assign a fit: AXIS=FIT, for example m12=H7/p6; AXIS is the id of a mate, "
                      "the name of a part, or 'all'");
  AddPairsOption(command, &options->pairs);
  AddConditionOption(command, &options->run.condition);
  AddForceMapOption(command, &options->run.force_map);
  AddGuidanceOptions(command, &options->run.guidance);
  Choices<person::PersonKind> persons;
  for (const auto kind :
       {person::PersonKind::kCareful, person::PersonKind::kHasty, person::PersonKind::kStiff}) {
    persons.emplace_back(person::ToString(kind), kind);
  }
  AddChoice(command, "--operator", &options->run.person,
            Choices<std::optional<person::PersonKind>>{{"guided", std::nullopt},
                                                       {"person", person::PersonKind::kCareful}},
            "What moves the parts without a device: a guided hand, which follows the planned ways, "
            "so that the result hangs on the product alone; or a simulated person, who aims, feels "
            "and searches; default: guided");
  AddChoice(command, "--person", &options->run.person, persons,
            "How a simulated person works, who then moves the parts: careful; hasty, three times "
            "as fast and with all its force at once; or stiff; both give way to nothing");
  command->add_option(
      "--device", options->device,
      "Address of the device for the hand (`hvas devices` lists them); emulated:DRIVER[:PROFILE] "
      "for an emulated one, held by the simulated person");
}

void AddRunOptions(CLI::App* command, RunCommandOptions* options) {
  command
      ->add_option("--scale", options->run.render.scale,
                   "Scale: millimetres of the scene for one millimetre of the device; default 0: "
                   "chosen by the sizes of both")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--rate", options->run.render.rate_hz, "Rate of the haptic loop [Hz]")
      ->check(CLI::Range(1000.0, 8000.0))
      ->capture_default_str();
  command->add_flag(
      "--realtime", options->run.is_realtime,
      "Run in real time instead of virtual time, with three threads at --rate, 100 and 30 Hz");
  CLI::Option* record =
      command->add_option("--record", options->run.record, "Record the session to this file");
  command->add_flag("--force", options->run.is_record_replaced, "Replace an existing record")
      ->needs(record);
  command
      ->add_option("--limit", options->run.limit_s,
                   "Stop after this session time [s]; default 0: 120 s for each part")
      ->check(CLI::Range(0.0, 1e9));
}

}  // namespace hvas::app
