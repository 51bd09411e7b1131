#include "app/assembly/assemble.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/assemble_report.h"
#include "app/assembly/rendering_options.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/product/load_product.h"
#include "base/clock.h"
#include "contact/shape_cache.h"
#include "device/opened_device.h"
#include "record/recorder.h"
#include "session/recorded_model.h"
#include "session/session_recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/model.h"

namespace hvas::app {
namespace {

using simulation::Model;
using simulation::PartResult;

constexpr int kNotAllSeated = 2;  // The exit status where a part is not in its place.
// Of session time, before a run is stopped as a whole: for a part, where it is carried around a
// product of ordinary size; in proportion for larger ones.
constexpr double kSecondsPerPart = 120;
constexpr double kOrdinaryRadius = 0.5;  // [m]

Result<std::shared_ptr<const Model>> MakeModel(const AssembleOptions& options,
                                               Diagnostics* diagnostics, bool is_watched) {
  auto product = LoadProduct(options.load, diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  if (!(product->mass() > 0)) {
    return Fail(ErrorCode::kUnsupported,
                "no part of the product has a mass, so there is nothing to assemble",
                product->source, "export the product with solids, not as surfaces");
  }
  simulation::CompileOptions compile;
  compile.seed = options.seed;
  compile.first_parts = options.order;
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
  return model;
}

record::Meta MakeMeta(const Model& model, const AssembleOptions& options) {
  static constexpr const char* kConditions[] = {"collision", "constraint", "hybrid"};
  record::Meta meta = session::MakeModelMeta(model);
  meta["condition"] = kConditions[static_cast<std::size_t>(options.condition)];
  meta["force_map"] = haptics::ToString(options.force_map);
  meta["device"] = options.device;
  meta["second_device"] = options.second_device;
  return meta;
}

/** What moves a hand: the simulated person alone or with an emulated device, or a device. */
struct Hand {
  std::string address;  ///< Of the device, as it was asked for; empty: none.
  device::OpenedDevice opened;
  haptics::TickOptions tick;
  std::unique_ptr<simulation::SimulatedPerson> person;
  std::unique_ptr<simulation::Operator> at_device;  ///< Null without a device.

  [[nodiscard]] simulation::Operator* active() const {
    return at_device != nullptr ? at_device.get() : person.get();
  }
};

haptics::TickOptions MakeTick(const Model& model, const AssembleOptions& options,
                              const device::Device* device) {
  haptics::TickOptions tick;
  if (device != nullptr) {
    tick = simulation::MakeTickOptions(device->info(), model, options.render);
  } else {
    tick.device.name = "simulated 6-DoF device";
    tick.dt = 1 / options.render.rate_hz;
  }
  tick.condition = options.condition;
  tick.force_map = options.force_map;
  return tick;
}

Result<Hand> MakeHand(const Model& model, const AssembleOptions& options,
                      const std::string& address, std::uint64_t seed) {
  Hand hand;
  hand.address = address;
  if (!address.empty()) {
    auto opened = device::OpenAnyDevice(address, options.is_realtime);
    if (!opened) {
      return Unexpected(opened.error());
    }
    hand.opened = std::move(*opened);
  }
  hand.tick = MakeTick(model, options, hand.opened.device.get());
  if (hand.opened.device != nullptr && hand.opened.emulator == nullptr) {
    hand.at_device = std::make_unique<simulation::DeviceOperator>(hand.opened.device.get());
    return hand;
  }
  simulation::PersonOptions habits;
  if (hand.opened.device != nullptr) {
    habits = simulation::MakePersonOptions(hand.tick);
  }
  hand.person =
      std::make_unique<simulation::SimulatedPerson>(habits, seed, simulation::StartOfHand(model));
  if (hand.opened.emulator != nullptr) {
    hand.at_device =
        std::make_unique<simulation::PersonAtDevice>(hand.person.get(), hand.opened.emulator.get(),
                                                     hand.opened.device.get(), options.is_realtime);
  }
  return hand;
}

/** One, or two where a second device is asked for. */
Result<std::vector<Hand>> MakeHands(const Model& model, const AssembleOptions& options) {
  std::vector<Hand> hands;
  auto first = MakeHand(model, options, options.device, simulation::SeedOfHand(options.seed, 0));
  if (!first) {
    return Unexpected(first.error());
  }
  hands.push_back(std::move(*first));
  if (!options.second_device.empty()) {
    auto second =
        MakeHand(model, options, options.second_device, simulation::SeedOfHand(options.seed, 1));
    if (!second) {
      return Unexpected(second.error());
    }
    hands.push_back(std::move(*second));
  }
  return hands;
}

std::unique_ptr<simulation::Simulation> MakeSimulation(const std::shared_ptr<const Model>& model,
                                                       const std::vector<Hand>& hands) {
  return hands.size() == 1
             ? std::make_unique<simulation::Simulation>(model, hands[0].tick)
             : std::make_unique<simulation::Simulation>(model, hands[0].tick, hands[1].tick);
}

/** Those that have a device, by hand. */
std::vector<DeviceInHand> DescribeDevices(const std::vector<Hand>& hands) {
  std::vector<DeviceInHand> devices;
  for (const Hand& hand : hands) {
    if (hand.opened.device != nullptr) {
      const device::DeviceInfo& info = hand.opened.device->info();
      devices.push_back({hand.address, info.model, info.profile.id, info.is_emulated,
                         simulation::DescribeRendering(info, hand.tick)});
    }
  }
  return devices;
}

/** Tells whoever waits how each device is rendered to. */
void ShowNotes(const std::vector<DeviceInHand>& devices) {
  for (std::size_t hand = 0; hand < devices.size(); ++hand) {
    const char* whose = devices.size() == 1 ? "" : NameOfHand(hand);
    for (const std::string& note : devices[hand].notes) {
      fmt::print(stderr, "hvas: {}{}{}: {}\n", whose, devices.size() == 1 ? "" : ": ",
                 devices[hand].model, note);
    }
  }
}

void ShowEachPart(const std::shared_ptr<const Model>& model, simulation::AssemblyRun* run) {
  run->on_part = [model, start_ns = MonotonicNs()](const simulation::AssemblyProgress& progress,
                                                   const PartResult& part) {
    const auto wall_ns = static_cast<double>(std::max<std::int64_t>(1, MonotonicNs() - start_ns));
    ShowProgress(
        fmt::format("part {} of {}, {} in place, {:.1f} x real time; {}{},", progress.tried,
                    progress.total, progress.seated, static_cast<double>(progress.t_ns) / wall_ns,
                    part.is_seated ? "" : "NOT IN PLACE: ",
                    Shorten(model->product->occurrences[part.occurrence.index()].path, 40)),
        static_cast<double>(progress.tried) / static_cast<double>(progress.total));
  };
}

double LimitOf(const Model& model, const AssembleOptions& options) {
  if (options.limit_s > 0) {
    return options.limit_s;
  }
  const double size = std::max(1.0, model.transfer_radius / kOrdinaryRadius);
  return kSecondsPerPart * size * static_cast<double>(model.bodies.size());
}

Result<std::unique_ptr<record::Recorder>> MakeRecorder(const Model& model,
                                                       const AssembleOptions& options) {
  record::RecorderOptions recorder;
  recorder.path = options.record;
  recorder.is_threaded = options.is_realtime;
  recorder.ring_ticks *= options.second_device.empty() ? 1 : 2;
  recorder.replaces = options.is_record_replaced;
  recorder.on_error = [](const Error& error) {
    fmt::print(stderr,
               "\n"
               "hvas: {} (the assembly continues)\n",
               error.ToString());
  };
  return record::Recorder::Create(recorder, MakeMeta(model, options));
}

Result<AssemblyOutcome> Assemble(const std::shared_ptr<const Model>& model,
                                 const AssembleOptions& options, bool is_watched) {
  auto recorder = MakeRecorder(*model, options);
  if (!recorder) {
    return Unexpected(recorder.error());
  }
  const auto hands = MakeHands(*model, options);
  if (!hands) {
    return Unexpected(hands.error());
  }
  AssemblyOutcome outcome;
  outcome.hands = hands->size();
  outcome.devices = DescribeDevices(*hands);
  const auto simulation = MakeSimulation(model, *hands);
  session::SessionRecorder sink(recorder->get(), *model);
  sink.Begin(simulation.get());
  const bool is_two = hands->size() == 2;
  const simulation::Persons persons{hands->front().person.get(),
                                    is_two ? hands->back().person.get() : nullptr};
  simulation::AssemblyRun run(simulation.get(), persons, &sink);
  simulation::FlightRecorder flight(options.render.rate_hz, hands->size());
  if (is_watched) {
    ShowNotes(outcome.devices);
    ShowEachPart(model, &run);
  }
  simulation::Execution execution = run.MakeExecution(
      hands->front().active(), LimitOf(*model, options), is_two ? hands->back().active() : nullptr);
  execution.flight = &flight;
  outcome.execution =
      options.is_realtime ? simulation::RunRealtime(execution) : simulation::RunLockstep(execution);
  outcome.parts = run.results();
  if (const auto finished = (*recorder)->Finish(); !finished) {
    outcome.record_error = finished.error();
  }
  outcome.digest = (*recorder)->Digest();
  outcome.dropped_ticks = (*recorder)->dropped_ticks();
  return outcome;
}

/** Parts that a stopped run did not come to. */
void AddMissing(const Model& model, AssemblyOutcome* outcome) {
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

/** What is in the hands, and how it is rendered to. */
void AddDeviceOptions(CLI::App* command, AssembleOptions* options) {
  command->add_option(
      "--device", options->device,
      "Address of the device for the hand (`hvas devices` lists them); emulated:DRIVER[:PROFILE] "
      "for an emulated one, held by the simulated person");
  command
      ->add_option(
          "--second-device", options->second_device,
          "Address of the device for the second hand. With an emulated device, a second simulated "
          "person takes every other part, and begins while the first is still inserting its part "
          "where their paths are apart; with a real device, its user chooses the parts")
      ->needs("--device");
  command
      ->add_option("--scale", options->render.scale,
                   "Scale: millimetres of the scene for one millimetre of the device; default 0: "
                   "chosen by the sizes of both")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--rate", options->render.rate_hz, "Rate of the haptic loop [Hz]")
      ->check(CLI::Range(1000.0, 8000.0))
      ->capture_default_str();
}

}  // namespace

int RunAssemble(const AssembleOptions& options) {
  const bool is_watched = !options.load.is_quiet && IsWatched();
  if (!options.record.empty()) {
    const auto target = record::CheckTarget(options.record, options.is_record_replaced);
    if (!target) {
      return ReportFailure(target.error());
    }
  }
  Diagnostics diagnostics;
  const std::int64_t start_ns = MonotonicNs();
  const auto model = MakeModel(options, &diagnostics, is_watched);
  if (!model) {
    return ReportFailure(model.error());
  }
  const std::int64_t ready_ns = MonotonicNs();
  for (const Diagnostic& item : diagnostics.items()) {
    if (item.code == "shape-cache" || item.code == "cache-unwritable") {
      fmt::print(stderr, "hvas: {}: {} ({})\n", item.entity, item.message, item.remedy);
    }
  }
  auto outcome = Assemble(*model, options, is_watched);
  if (!outcome) {
    return ReportFailure(outcome.error());
  }
  AddMissing(**model, &*outcome);
  outcome->preparation_ns = ready_ns - start_ns;
  outcome->seed = options.seed;
  outcome->is_realtime = options.is_realtime;
  outcome->force_map = options.force_map;
  if (options.is_json) {
    PrintAssemblyJson(**model, *outcome);
  } else {
    PrintAssemblyTable(**model, *outcome);
  }
  if (outcome->record_error) {
    return ReportFailure(*outcome->record_error);
  }
  const bool is_complete = std::all_of(outcome->parts.begin(), outcome->parts.end(),
                                       [](const PartResult& part) { return part.is_seated; });
  return is_complete ? 0 : kNotAllSeated;
}

void AddAssemble(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "assemble", "Let a simulated person assemble a product part by part, and record the session");
  const auto options = std::make_shared<AssembleOptions>();
  command->add_option("file", options->load.file, "STEP, STL, OBJ, glTF or 3MF file")->required();
  command
      ->add_option("--order", options->order,
                   "Parts to assemble first, by name, path or id (o12), separated by commas; the "
                   "others follow in the order that HVAS finds")
      ->delimiter(',');
  command
      ->add_option("--seed", options->seed,
                   "Seed for the person's motion and the parts' actual sizes")
      ->capture_default_str();
  command->add_option("--fit", options->load.fits,
                      "Assign a fit: AXIS=FIT, for example m12=H7/p6; AXIS is the id of a mate, "
                      "the name of a part, or 'all'");
  AddConditionOption(command, &options->condition);
  AddForceMapOption(command, &options->force_map);
  AddDeviceOptions(command, options.get());
  command->add_flag(
      "--realtime", options->is_realtime,
      "Run in real time instead of virtual time, with three threads at --rate, 100 and 30 Hz");
  CLI::Option* record =
      command->add_option("--record", options->record, "Record the session to this file");
  command->add_flag("--force", options->is_record_replaced, "Replace an existing record")
      ->needs(record);
  command
      ->add_option("--limit", options->limit_s,
                   "Stop after this session time [s]; default 0: 120 s for each part")
      ->check([](const std::string& text) {
        double limit_s = 0;
        const char* end = text.data() + text.size();
        const auto [rest, code] = std::from_chars(text.data(), end, limit_s);
        const bool is_time = code == std::errc() && rest == end && limit_s >= 0 && limit_s <= 1e9;
        return is_time ? std::string() : "must be a time in seconds, 0 or more";
      });
  AddJsonFlag(command, &options->is_json, "assemble");
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0 when every part is in its place, 2 when one is not, 1 on an error.\n"
      "Examples:\n"
      "  hvas assemble products/gear_pump.step\n"
      "  hvas assemble products/bushing.step --fit shaft=H7/p6 --record press.hvasrec\n"
      "  hvas assemble pump.step --device forcedimension --realtime\n"
      "  hvas assemble pump.step --device emulated:openhaptics:touch_x\n"
      "  hvas assemble pump.step --device emulated:openhaptics --second-device emulated:haply\n"
      "  hvas assemble pump.step --device forcedimension --second-device haply --realtime\n"
      "  hvas assemble pump.step --json --seed 7 | jq '.parts[] | select(.seated | not)'");
  command->callback([options, status] { *status = RunAssemble(*options); });
}

}  // namespace hvas::app
