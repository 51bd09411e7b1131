#include "app/assemble.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/load_product.h"
#include "app/progress.h"
#include "app/session_recorder.h"
#include "base/units.h"
#include "contact/shape_cache.h"
#include "record/recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/model.h"

namespace hvas::app {
namespace {

using simulation::ExecutionReport;
using simulation::Model;
using simulation::PartResult;

constexpr int kNotAllSeated = 2;
constexpr double kSecondsPerPart = 120;  // of session time, before a run is stopped as a whole

struct Outcome {
  std::vector<PartResult> parts;
  ExecutionReport execution;
  std::string digest;
  std::uint64_t dropped_ticks{0};
};

/** Percentiles of a histogram in microseconds. */
nlohmann::ordered_json ToJsonUs(const LatencyHistogram& histogram) {
  const auto us = [](std::int64_t time_ns) { return 1e-3 * static_cast<double>(time_ns); };
  return {{"median", us(histogram.Quantile(0.5))},
          {"p99", us(histogram.Quantile(0.99))},
          {"p999", us(histogram.Quantile(0.999))},
          {"max", us(histogram.max_ns())}};
}

double RealTimeFactor(const ExecutionReport& report) {
  return report.wall_ns > 0
             ? static_cast<double>(report.session_ns) / static_cast<double>(report.wall_ns)
             : 0.0;
}

nlohmann::ordered_json ToJson(const Model& model, const Outcome& outcome,
                              const AssembleOptions& options) {
  nlohmann::ordered_json json;
  const ExecutionReport& run = outcome.execution;
  json["product"] = model.product->name;
  json["source"] = model.product->source;
  json["seed"] = options.seed;
  json["digest"] = outcome.digest;
  json["session_s"] = 1e-9 * static_cast<double>(run.session_ns);
  json["wall_s"] = 1e-9 * static_cast<double>(run.wall_ns);
  json["real_time_factor"] = RealTimeFactor(run);
  json["ticks"] = run.ticks;
  json["tick_us"] = ToJsonUs(run.compute);
  json["scheduling"] = run.scheduling;
  if (options.is_realtime) {
    json["ticks_per_s"] = 1e9 * static_cast<double>(run.ticks) / static_cast<double>(run.wall_ns);
    json["wake_up_us"] = ToJsonUs(run.wake_up);
    json["late_wake_ups"] = run.late_wake_ups;
    json["overruns"] = run.overruns;
    json["dropped_ticks"] = outcome.dropped_ticks;
  }
  json["seated"] = std::count_if(outcome.parts.begin(), outcome.parts.end(),
                                 [](const PartResult& part) { return part.is_seated; });
  json["parts"] = nlohmann::ordered_json::array();
  for (const PartResult& part : outcome.parts) {
    json["parts"].push_back({{"id", part.occurrence.value()},
                             {"name", model.product->occurrences[part.occurrence.index()].path},
                             {"seated", part.is_seated},
                             {"reason", part.reason},
                             {"note", part.note},
                             {"time_s", part.time},
                             {"path_m", part.path},
                             {"peak_true_n", part.peak_true},
                             {"peak_felt_n", part.peak_felt},
                             {"deepest_um", units::ToUm(part.deepest)},
                             {"mates", part.mates},
                             {"pose_error_um", units::ToUm(part.pose_error)},
                             {"pose_error_urad", 1e6 * part.pose_error_angle}});
  }
  return json;
}

/** Shortened in front, where paths repeat; on a code point's border. */
std::string Shorten(const std::string& text, std::size_t width) {
  if (text.size() <= width) {
    return text;
  }
  std::size_t start = text.size() - width + 2;
  while (start < text.size() && (static_cast<unsigned char>(text[start]) & 0xC0U) == 0x80U) {
    ++start;
  }
  return ".." + text.substr(start);
}

void PrintTable(const Model& model, const Outcome& outcome, bool is_realtime) {
  fmt::print("{:>3}  {:<44} {:>7} {:>7} {:>11} {:>7} {:>5} {:>8} {:>9}  {}\n", "#", "part",
             "time_s", "path_m", "peak_true_n", "felt_n", "mates", "error_um", "error_urad", "");
  std::size_t seated = 0;
  for (std::size_t i = 0; i < outcome.parts.size(); ++i) {
    const PartResult& part = outcome.parts[i];
    seated += part.is_seated ? 1 : 0;
    const std::string name = Shorten(model.product->occurrences[part.occurrence.index()].path, 44);
    if (!part.is_seated) {
      fmt::print("{:>3}  {:<44} NOT IN PLACE: {}\n", i + 1, name, part.reason);
      continue;
    }
    fmt::print("{:>3}  {:<44} {:>7.2f} {:>7.3f} {:>11.2f} {:>7.2f} {:>5} {:>8.1e} {:>9.1e}  {}\n",
               i + 1, name, part.time, part.path, part.peak_true, part.peak_felt, part.mates,
               units::ToUm(part.pose_error), 1e6 * part.pose_error_angle,
               part.time == 0 ? "in the fixture" : part.note);
  }
  const ExecutionReport& run = outcome.execution;
  const auto us = [](std::int64_t time_ns) { return 1e-3 * static_cast<double>(time_ns); };
  fmt::print(
      "\n{}: {} of {} parts in place after {:.1f} s of work, computed in {:.1f} s ({:.1f} x real "
      "time)\ntick compute: median {:.1f}, p99 {:.1f}, p99.9 {:.1f}, max {:.1f} us ({} ticks, "
      "{})\n",
      model.product->source, seated, outcome.parts.size(),
      1e-9 * static_cast<double>(run.session_ns), 1e-9 * static_cast<double>(run.wall_ns),
      RealTimeFactor(run), us(run.compute.Quantile(0.5)), us(run.compute.Quantile(0.99)),
      us(run.compute.Quantile(0.999)), us(run.compute.max_ns()), run.ticks, run.scheduling);
  if (is_realtime) {
    fmt::print(
        "realtime: {:.1f} ticks per second; wake-up median {:.1f}, p99 {:.1f}, max {:.1f} us; {} "
        "late wake-ups, {} overruns, {} ticks not recorded\n",
        1e9 * static_cast<double>(run.ticks) / static_cast<double>(run.wall_ns),
        us(run.wake_up.Quantile(0.5)), us(run.wake_up.Quantile(0.99)), us(run.wake_up.max_ns()),
        run.late_wake_ups, run.overruns, outcome.dropped_ticks);
  }
  fmt::print("digest {}\n", outcome.digest);
}

Result<std::shared_ptr<const Model>> MakeModel(const AssembleOptions& options,
                                               Diagnostics* diagnostics, bool is_watched) {
  auto product = LoadProduct(options.load, diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  if (!(product->mass() > 0)) {
    return Fail(ErrorCode::kUnsupported,
                "no part of it has a mass, so there is nothing to assemble", product->source,
                "export it with its solids, not as surfaces");
  }
  simulation::CompileOptions compile;
  compile.seed = options.seed;
  if (const auto directory = CacheDirectory(options.load)) {
    compile.shape_cache = std::make_shared<contact::ShapeCache>(*directory);
  }
  if (is_watched) {
    compile.progress = [](const std::string& stage, double fraction) {
      ShowProgress(stage, fraction);
    };
  }
  auto model = simulation::Compile(std::make_shared<product::Product>(std::move(*product)), compile,
                                   diagnostics);
  if (!model) {
    return model;
  }
  if (const auto strict = CheckStrict(options.load, *diagnostics); !strict) {
    return Unexpected(strict.error());
  }
  if (options.order.empty()) {
    return model;
  }
  auto sequence = simulation::Reorder(*(*model)->product, (*model)->sequence, options.order);
  if (!sequence) {
    return Unexpected(sequence.error());
  }
  auto reordered = std::make_shared<Model>(**model);
  reordered->sequence = std::move(*sequence);
  return std::shared_ptr<const Model>(std::move(reordered));
}

record::Meta MakeMeta(const Model& model, const AssembleOptions& options) {
  static constexpr const char* kConditions[] = {"collision", "constraint", "hybrid"};
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const product::Occurrence& occurrence : model.product->occurrences) {
    parts.push_back({{"id", occurrence.id.value()},
                     {"path", occurrence.path},
                     {"shape_hash", model.product->part_of(occurrence.id).shape_hash}});
  }
  return {{"product", model.product->name},
          {"source", model.product->source},
          {"seed", std::to_string(options.seed)},
          {"condition", kConditions[static_cast<std::size_t>(options.condition)]},
          {"model_json", parts.dump()}};
}

Result<Outcome> Assemble(const std::shared_ptr<const Model>& model, const AssembleOptions& options,
                         bool is_watched) {
  record::RecorderOptions record_options;
  record_options.path = options.record;
  record_options.is_threaded = options.is_realtime;
  auto recorder = record::Recorder::Create(record_options, MakeMeta(*model, options));
  if (!recorder) {
    return Unexpected(recorder.error());
  }
  haptics::TickOptions tick;
  tick.condition = options.condition;
  tick.device.name = "simulated 6-DoF device";
  simulation::Simulation simulation(model, tick);
  simulation::SimulatedPerson person({}, options.seed, simulation::StartOfHand(*model));
  SessionRecorder sink(recorder->get());
  simulation::AssemblyRun run(&simulation, &person, &sink);
  if (is_watched) {
    run.on_part = [&model](std::size_t done, std::size_t total, const PartResult& part) {
      ShowProgress(
          fmt::format("part {} of {} {}: {}", done, total, part.is_seated ? "in place" : "FAILED",
                      Shorten(model->product->occurrences[part.occurrence.index()].path, 40)),
          done == total ? 1.0 : static_cast<double>(done) / static_cast<double>(total));
    };
  }
  simulation::Execution execution;
  execution.simulation = &simulation;
  execution.hand = &person;
  execution.sink = &run;
  execution.advance = [&run] { run.Advance(); };
  execution.is_done = [&run] { return run.is_done(); };
  const double limit_s = options.limit_s > 0
                             ? options.limit_s
                             : kSecondsPerPart * static_cast<double>(model->bodies.size());
  execution.limit_ns = std::llround(1e9 * limit_s);
  Outcome outcome;
  outcome.execution =
      options.is_realtime ? simulation::RunRealtime(execution) : simulation::RunLockstep(execution);
  outcome.parts = run.results();
  if (const auto finished = (*recorder)->Finish(); !finished) {
    return Unexpected(finished.error());
  }
  outcome.digest = (*recorder)->Digest();
  outcome.dropped_ticks = (*recorder)->dropped_ticks();
  return outcome;
}

/** Parts that a stopped run did not come to. */
void AddMissing(const Model& model, Outcome* outcome) {
  for (const product::Occurrence& occurrence : model.product->occurrences) {
    const bool is_listed =
        std::any_of(outcome->parts.begin(), outcome->parts.end(),
                    [&](const PartResult& part) { return part.occurrence == occurrence.id; });
    if (!is_listed) {
      PartResult part;
      part.occurrence = occurrence.id;
      part.reason = "the run was stopped before its turn ended";
      outcome->parts.push_back(part);
    }
  }
}

}  // namespace

int RunAssemble(const AssembleOptions& options) {
  const bool is_watched = !options.load.is_quiet && IsWatched();
  const auto fail = [](const Error& error) {
    fmt::print(stderr, "hvas: {}\n", error.ToString());
    return 1;
  };
  Diagnostics diagnostics;
  const auto model = MakeModel(options, &diagnostics, is_watched);
  if (!model) {
    return fail(model.error());
  }
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "shape-cache" || item.code == "cache-unwritable") {
      fmt::print(stderr, "hvas: {}: {} ({})\n", item.entity, item.message, item.remedy);
    }
  }
  auto outcome = Assemble(*model, options, is_watched);
  if (!outcome) {
    return fail(outcome.error());
  }
  AddMissing(**model, &*outcome);
  if (options.is_json) {
    fmt::print("{}\n", ToJson(**model, *outcome, options)
                           .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    PrintTable(**model, *outcome, options.is_realtime);
  }
  const bool is_complete = std::all_of(outcome->parts.begin(), outcome->parts.end(),
                                       [](const PartResult& part) { return part.is_seated; });
  return is_complete ? 0 : kNotAllSeated;
}

void AddAssemble(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "assemble", "Let a simulated person assemble a product, part by part, and keep the evidence");
  const auto options = std::make_shared<AssembleOptions>();
  command->add_option("file", options->load.file, "STEP, STL, OBJ, glTF or 3MF file")->required();
  command
      ->add_option("--order", options->order,
                   "Parts to begin with, by name, path or id (o12), separated by commas; the rest "
                   "follows in the order found")
      ->delimiter(',');
  command->add_option("--seed", options->seed, "Seed of the person and of the parts' actual sizes")
      ->capture_default_str();
  command->add_option("--fit", options->load.fits,
                      "AXIS=FIT, as in m12=H7/p6: a mate's id, a part's name, or 'all'");
  const std::map<std::string, haptics::Condition> conditions{
      {"collision", haptics::Condition::kCollision},
      {"constraint", haptics::Condition::kConstraint},
      {"hybrid", haptics::Condition::kHybrid}};
  command
      ->add_option("--condition", options->condition,
                   "collision, constraint, or hybrid (both, and the force of the fit)")
      ->transform(CLI::CheckedTransformer(conditions, CLI::ignore_case));
  command->add_flag("--realtime", options->is_realtime,
                    "Three threads at 1000, 100 and 30 Hz instead of virtual time");
  command->add_option("--record", options->record, "Write the session to this file");
  command->add_option("--limit", options->limit_s, "Stop after this session time [s]")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", options->is_json, "Print one JSON document");
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0 when every part is in its place, 2 when one is not, 1 on an error.\n"
      "Examples:\n"
      "  hvas assemble products/gear_pump.step\n"
      "  hvas assemble products/bushing.step --fit shaft=H7/p6 --record press.hvasrec\n"
      "  hvas assemble pump.step --json --seed 7 | jq '.parts[] | select(.seated | not)'");
  command->callback([options, status] { *status = RunAssemble(*options); });
}

}  // namespace hvas::app
