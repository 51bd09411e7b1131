#include "app/assembly/disassemble.h"

#include <functional>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "app/assembly/disassemble_report.h"
#include "app/end_watch.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "assembly/run_disassembly.h"
#include "base/clock.h"
#include "base/crash_note.h"

namespace hvas::app {
namespace {

constexpr int kNotAllOut = 2;  // The exit status where a part has not come out.

}  // namespace

int RunDisassemble(const DisassembleOptions& options) {
  const EndWatch end;  // What was done until the program is ended is printed.
  PreparationProgress preparation;
  const auto model = PrepareRun(options, {}, end.stop(), &preparation);
  if (!model) {
    return ReportUnprepared(options, preparation, model.error());
  }
  std::function<void(double fraction)> progress;
  if (IsShown(options)) {
    progress = [](double fraction) { ShowProgress("order of disassembly", fraction); };
  }
  NoteStage("order of disassembly");
  const auto plan = assembly::PlanDisassembly(**model, options.part, progress);
  if (progress) {
    progress(1);  // A plan for one part ends before all parts were looked at.
  }
  if (!plan) {
    return ReportFailure(plan.error());
  }
  const std::int64_t preparation_ns = MonotonicNs() - preparation.start_ns;
  assembly::RunOptions run_options = MakeRunOptions(
      options, *model,
      {"disassembly", "out", "NOT OUT: ", [](const auto& part) { return part.reason.empty(); }});
  run_options.stop = end.stop();
  auto run = assembly::RunDisassembly(*model, *plan, run_options);
  if (!run) {
    return ReportFailure(run.error());
  }
  const bool is_complete = run->is_complete();
  const SessionReport report = MakeSessionReport(options, std::move(run->run), preparation_ns);
  if (options.is_json) {
    PrintDisassemblyJson(**model, *plan, report);
  } else {
    PrintDisassemblyTable(**model, *plan, report);
  }
  if (report.run.record_error) {
    return ReportFailure(*report.run.record_error);
  }
  return is_complete ? 0 : kNotAllOut;
}

void AddDisassemble(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("disassemble", "Let a simulated person take a product apart");
  const auto options = std::make_shared<DisassembleOptions>();
  command->add_option("file", options->load.file, "STEP, IGES or mesh file, or a folder of meshes")
      ->required();
  command->add_option("--part", options->part,
                      "The part to get out, by name, path or id (o12): the smallest set of parts "
                      "in its way comes first; without it, all parts come off the base");
  AddFitAndDeviceOptions(command, options.get());
  AddRunOptions(command, options.get());
  AddJsonFlag(command, &options->is_json, "disassemble or preparation");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load);
  command->footer(
      "The parts start in their place. Each comes out along a straight way that mates and the "
      "parts "
      "still in place leave free, and is put down on the table.\n"
      "Exit status: 0 when every part has come out, 2 when one has not, 1 on an error.\n"
      "Examples:\n"
      "  hvas disassemble products/gear_pump.step\n"
      "  hvas disassemble products/gear_pump.step --part \"oil seal\"\n"
      "  hvas disassemble products/bushing.step --fit shaft=H7/p6 --record pull.hvasrec\n"
      "  hvas disassemble pump.step --part o12 --device forcedimension --realtime\n"
      "  hvas disassemble pump.step --json | jq '.parts[] | select(.out | not)'");
  command->callback([options, status] { *status = RunDisassemble(*options); });
}

}  // namespace hvas::app
