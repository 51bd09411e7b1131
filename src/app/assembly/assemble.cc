#include "app/assembly/assemble.h"

#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/assemble_report.h"
#include "app/assembly/left_out.h"
#include "app/end_watch.h"
#include "app/output/json_flag.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "base/clock.h"

namespace hvas::app {
namespace {

constexpr int kNotAllSeated = 2;  // The exit status where a part is not in its place.

/** Names the command whose page has pictures of the reasons; nothing where there are none. */
void PrintWhereReasonsAreDrawn(const LeftOut& left_out, const AssembleOptions& options) {
  if (left_out.reasons->empty()) {
    return;
  }
  const std::string& record = options.run.record.string();
  fmt::print("{}", Wrap(fmt::format("Pictures of what stops them: hvas {} -o why.html",
                                    record.empty() ? "plan " + options.load.file.string()
                                                   : "report " + record),
                        0));
}

}  // namespace

int RunAssemble(const AssembleOptions& options) {
  const EndWatch end;  // What was done until the program is ended is printed.
  PreparationProgress progress;
  const auto model = PrepareRun(options, options.order, end.stop(), &progress);
  if (!model) {
    return ReportUnprepared(options, progress, model.error());
  }
  const std::int64_t preparation_ns = MonotonicNs() - progress.start_ns;
  assembly::RunOptions run_options = MakeRunOptions(
      options, *model,
      {"assembly", "in place", "NOT IN PLACE: ", [](const auto& part) { return part.is_seated; }});
  if (!options.second_device.empty()) {
    run_options.devices.push_back(options.second_device);
  }
  run_options.stop = end.stop();
  auto run = assembly::RunAssembly(*model, run_options);
  if (!run) {
    return ReportFailure(run.error());
  }
  const SessionReport report = MakeSessionReport(options, std::move(*run), preparation_ns);
  const auto reasons =
      ExplainLeftOut(**model, options.reasons_s, options.load.is_quiet, end.stop());
  const LeftOut left_out{&**model, &reasons};
  if (options.is_json) {
    PrintAssemblyJson(**model, report, left_out);
  } else {
    PrintAssemblyTable(**model, report);
    if (options.reasons_s > 0) {
      PrintLeftOut(left_out);
      PrintWhereReasonsAreDrawn(left_out, options);
    }
  }
  if (report.run.record_error) {
    return ReportFailure(*report.run.record_error);
  }
  return report.run.is_complete() ? 0 : kNotAllSeated;
}

void AddAssemble(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand("assemble", "Assemble a product along its planned ways");
  const auto options = std::make_shared<AssembleOptions>();
  command->add_option("file", options->load.file, "STEP, IGES or mesh file, or a folder of meshes")
      ->required();
  command
      ->add_option("--order", options->order.first_parts,
                   "Parts to assemble first, by name, path or id (o12), separated by commas; the "
                   "others follow in the order that HVAS finds")
      ->delimiter(',');
  AddOrderChoice(command, &options->order);
  command
      ->add_option("--plan", options->order.plan,
                   "A plan that hvas plan has written with -o: its order and its ways are followed")
      ->excludes("--order")
      ->excludes("--base");
  AddFitAndDeviceOptions(command, options.get());
  command
      ->add_option(
          "--second-device", options->second_device,
          "Address of the device for the second hand. With an emulated device, a second simulated "
          "person takes every other part, and begins while the first is still inserting its part "
          "where their paths are apart; with a real device, its user chooses the parts")
      ->needs("--device");
  AddRunOptions(command, options.get());
  AddReasonsOption(command, &options->reasons_s);
  AddJsonFlag(command, &options->is_json, "assemble or preparation");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0 when every part is in its place, 2 when one is not, 1 on an error.\n"
      "Ctrl+C and SIGTERM end the assembly: what was done until then is printed.\n"
      "Examples:\n"
      "  hvas assemble products/gear_pump.step\n"
      "  hvas assemble products/bushing.step --fit shaft=H7/p6 --record press.hvasrec\n"
      "  hvas plan pump.step -o plan.json && hvas assemble pump.step --plan plan.json\n"
      "  hvas assemble pump.step --device forcedimension --realtime\n"
      "  hvas assemble pump.step --device emulated:openhaptics:touch_x\n"
      "  hvas assemble pump.step --device emulated:openhaptics --second-device emulated:haply\n"
      "  hvas assemble pump.step --device forcedimension --second-device haply --realtime\n"
      "  hvas assemble pump.step --json --seed 7 | jq '.parts[] | select(.seated | not)'");
  command->callback([options, status] { *status = RunAssemble(*options); });
}

}  // namespace hvas::app
