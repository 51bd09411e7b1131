#include "app/assembly/plan.h"

#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/plan_report.h"
#include "app/assembly/planned_model.h"
#include "app/end_watch.h"
#include "app/output/json_flag.h"
#include "app/output/new_file.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "base/atomic_file.h"

namespace hvas::app {
namespace {

constexpr int kNotAllPlanned = 2;  // The exit status where a part is left out.

Result<void> CheckOutput(const PlanCommandOptions& options) {
  if (options.output.empty()) {
    return {};
  }
  const std::filesystem::path ending = options.output.extension();
  if (ending != ".json" && ending != ".html" && ending != ".pdf") {
    return Fail(ErrorCode::kInvalid,
                "the file name has no extension of a format that can be written",
                options.output.string(), "use the extension .json, .html or .pdf");
  }
  return CheckNewFile(options.output, options.is_replaced);
}

Result<void> WriteOutput(const PlanCommandOptions& options, const PlanReport& report) {
  if (options.output.empty()) {
    return {};
  }
  return options.output.extension() == ".json"
             ? WriteAtomically(options.output, MakePlanJson(report).dump(1) + "\n")
             : WritePage(options.output, MakePlanPage(report));
}

}  // namespace

int RunPlan(const PlanCommandOptions& options) {
  const EndWatch end;
  if (const auto checked = CheckOutput(options); !checked) {
    return ReportFailure(checked.error());
  }
  const auto planned = PlanModel(options, end);
  if (!planned) {
    return planned.error();
  }
  const PlanReport report{planned->model.get(), &planned->plan, options.plan.weights,
                          planned->preparation_s, planned->planning_s};
  if (const auto written = WriteOutput(options, report); !written) {
    return ReportFailure(written.error());
  }
  if (options.is_json) {
    PrintJson(MakePlanJson(report));
  } else {
    PrintPlanTable(report);
  }
  return planned->model->sequence.gaps.empty() ? 0 : kNotAllPlanned;
}

void AddPlan(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand("plan", "Find orders of assembly of low cost");
  const auto options = std::make_shared<PlanCommandOptions>();
  command->add_option("file", options->load.file, "STEP, IGES or mesh file, or a folder of meshes")
      ->required();
  AddOrderChoice(command, &options->order);
  AddOrderOptions(command, options.get());
  command
      ->add_option("--orders", options->plan.most_orders, "How many of the best orders are given")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--front", options->plan.gives_front,
                    "Give all orders found of which none is better in everything (Pareto front)");
  command->add_option("-o,--output", options->output,
                      "File to write: .json, which hvas assemble --plan follows, .html or .pdf");
  command->add_flag("--force", options->is_replaced, "Replace an existing file");
  AddJsonFlag(command, &options->is_json, "plan or preparation");
  AddAccessoryOptions(command, &options->load);
  AddLoadOptions(command, &options->load);
  command->footer(
      "Exit status: 0 when the order has every part, 2 when one is left out, 1 on an error.\n"
      "Examples:\n"
      "  hvas plan products/gear_pump.step\n"
      "  hvas plan products/gear_pump.step -o plan.json\n"
      "  hvas assemble products/gear_pump.step --plan plan.json\n"
      "  hvas plan pump.step --base housing --before \"oil seal\" cover --tool-cost 5\n"
      "  hvas plan pump.step --json | jq '.arrows[] | select(.certain) | .reason'");
  command->callback([options, status] { *status = RunPlan(*options); });
}

}  // namespace hvas::app
