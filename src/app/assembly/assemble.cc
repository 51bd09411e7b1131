#include "app/assembly/assemble.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
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
#include "assembly/prepare_model.h"
#include "base/clock.h"
#include "record/recorder.h"

namespace hvas::app {
namespace {

using simulation::Model;
using simulation::PartResult;

constexpr int kNotAllSeated = 2;  // The exit status where a part is not in its place.

Result<std::shared_ptr<const Model>> MakeModel(const AssembleOptions& options,
                                               Diagnostics* diagnostics, bool is_watched) {
  auto product = LoadProduct(options.load, diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  assembly::PrepareOptions prepare;
  prepare.seed = options.run.seed;
  prepare.first_parts = options.order;
  prepare.shape_cache = assembly::MakeShapeCache(CacheDirectory(options.load));
  if (is_watched) {
    prepare.progress = ShowProgress;
  }
  auto model = assembly::PrepareModel(std::move(*product), prepare, diagnostics);
  if (!model) {
    return model;
  }
  if (const auto strict = CheckStrict(options.load, *diagnostics); !strict) {
    return Unexpected(strict.error());
  }
  return model;
}

/** Tells whoever waits how each device is rendered to. */
void ShowNotes(const std::vector<assembly::DeviceInHand>& devices) {
  for (const assembly::DeviceInHand& device : devices) {
    const char* whose = devices.size() == 1 ? "" : NameOfHand(device.hand);
    for (const std::string& note : device.notes) {
      fmt::print(stderr, "hvas: {}{}{}: {}\n", whose, devices.size() == 1 ? "" : ": ", device.model,
                 note);
    }
  }
}

void ShowPart(const Model& model, std::int64_t start_ns,
              const simulation::AssemblyProgress& progress, const PartResult& part) {
  const auto wall_ns = static_cast<double>(std::max<std::int64_t>(1, MonotonicNs() - start_ns));
  ShowProgress(
      fmt::format("part {} of {}, {} in place, {:.1f} x real time; {}{},", progress.tried,
                  progress.total, progress.seated, static_cast<double>(progress.t_ns) / wall_ns,
                  part.is_seated ? "" : "NOT IN PLACE: ",
                  Shorten(model.product->occurrences[part.occurrence.index()].path, 40)),
      static_cast<double>(progress.tried) / static_cast<double>(progress.total));
}

/** What is asked for, and who is told. */
assembly::RunOptions MakeRunOptions(const AssembleOptions& options,
                                    const std::shared_ptr<const Model>& model, bool is_watched) {
  assembly::RunOptions run = options.run;
  run.devices = {options.device};
  if (!options.second_device.empty()) {
    run.devices.push_back(options.second_device);
  }
  if (is_watched) {
    run.on_begin = ShowNotes;
    run.on_part = [model, start_ns = MonotonicNs()](const auto& progress, const PartResult& part) {
      ShowPart(*model, start_ns, progress, part);
    };
  }
  run.on_record_error = [](const Error& error) {
    fmt::print(stderr, "\nhvas: {} (the assembly continues)\n", error.ToString());
  };
  return run;
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
      ->add_option("--scale", options->run.render.scale,
                   "Scale: millimetres of the scene for one millimetre of the device; default 0: "
                   "chosen by the sizes of both")
      ->check(CLI::Range(0.0, 1000.0));
  command->add_option("--rate", options->run.render.rate_hz, "Rate of the haptic loop [Hz]")
      ->check(CLI::Range(1000.0, 8000.0))
      ->capture_default_str();
}

}  // namespace

int RunAssemble(const AssembleOptions& options) {
  const bool is_watched = !options.load.is_quiet && IsWatched();
  if (!options.run.record.empty()) {
    const auto target = record::CheckTarget(options.run.record, options.run.is_record_replaced);
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
  auto run = assembly::RunAssembly(*model, MakeRunOptions(options, *model, is_watched));
  if (!run) {
    return ReportFailure(run.error());
  }
  AssemblyReport report;
  report.run = std::move(*run);
  report.preparation_ns = ready_ns - start_ns;
  report.seed = options.run.seed;
  report.is_realtime = options.run.is_realtime;
  report.force_map = options.run.force_map;
  if (options.is_json) {
    PrintAssemblyJson(**model, report);
  } else {
    PrintAssemblyTable(**model, report);
  }
  if (report.run.record_error) {
    return ReportFailure(*report.run.record_error);
  }
  return report.run.is_complete() ? 0 : kNotAllSeated;
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
      ->add_option("--seed", options->run.seed,
                   "Seed for the person's motion and the parts' actual sizes")
      ->capture_default_str();
  command->add_option("--fit", options->load.fits,
                      "Assign a fit: AXIS=FIT, for example m12=H7/p6; AXIS is the id of a mate, "
                      "the name of a part, or 'all'");
  AddConditionOption(command, &options->run.condition);
  AddForceMapOption(command, &options->run.force_map);
  AddDeviceOptions(command, options.get());
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
