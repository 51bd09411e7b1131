#include "app/assembly/plan.h"

#include <memory>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/assembly/plan_report.h"
#include "app/end_watch.h"
#include "app/output/json_flag.h"
#include "app/output/new_file.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/recording/page_file.h"
#include "base/atomic_file.h"
#include "base/clock.h"

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
  PreparationProgress progress;
  const auto model = PrepareRun(options, options.order, end.stop(), &progress);
  if (!model) {
    return ReportUnprepared(options, progress, model.error());
  }
  const std::int64_t prepared_ns = MonotonicNs();
  assembly::PlanOptions plan_options = options.plan;
  for (std::size_t i = 0; i + 1 < options.before.size(); i += 2) {
    plan_options.before.emplace_back(options.before[i], options.before[i + 1]);
  }
  if (options.time_s > 0) {
    plan_options.time = std::chrono::duration<double>(options.time_s);
  }
  plan_options.stop = end.stop();
  if (IsShown(options)) {
    plan_options.progress = [](const std::string& stage, double fraction) {
      ShowProgress(stage, fraction);
    };
  }
  const auto plan = assembly::PlanOrder(**model, plan_options);
  if (IsShown(options)) {
    ShowProgress("order of least cost", 1);
  }
  if (!plan) {
    return ReportFailure(plan.error());
  }
  const PlanReport report{&**model, &*plan, plan_options.weights,
                          1e-9 * static_cast<double>(prepared_ns - progress.start_ns),
                          1e-9 * static_cast<double>(MonotonicNs() - prepared_ns)};
  if (const auto written = WriteOutput(options, report); !written) {
    return ReportFailure(written.error());
  }
  if (options.is_json) {
    PrintJson(MakePlanJson(report));
  } else {
    PrintPlanTable(report);
  }
  return (*model)->sequence.gaps.empty() ? 0 : kNotAllPlanned;
}

void AddPlan(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand("plan", "Find orders of assembly of low cost");
  const auto options = std::make_shared<PlanCommandOptions>();
  command->add_option("file", options->load.file, "STEP, IGES or mesh file, or a folder of meshes")
      ->required();
  AddBaseOption(command, &options->order.base);
  command
      ->add_option("--order", options->plan.order,
                   "Parts that have to come in this order, by name, path or id (o12), separated by "
                   "commas; the others come between them where it is best")
      ->delimiter(',');
  command
      ->add_option("--before", options->before,
                   "Two parts: the first has to come before the second. May be given repeatedly")
      ->type_size(2)
      ->expected(1, CLI::detail::expected_max_vector_size);
  simulation::OrderWeights& weights = options->plan.weights;
  command->add_option("--turn-cost", weights.turn, "Cost of turning the product")
      ->capture_default_str();
  command
      ->add_option("--direction-cost", weights.direction_change,
                   "Cost of a part that comes from another direction than the one before it")
      ->capture_default_str();
  command->add_option("--tool-cost", weights.tool_change, "Cost of a change of tool")
      ->capture_default_str();
  command
      ->add_option("--loose-cost", weights.loose, "Cost of a part that nothing holds when it comes")
      ->capture_default_str();
  command
      ->add_option("--cramped-cost", weights.cramped,
                   "Cost of a fastener that comes when parts stand where its tool turns")
      ->capture_default_str();
  command
      ->add_option("--reach-cost", weights.reach,
                   "Cost of each metre by which the hand goes in among the parts that are there")
      ->capture_default_str();
  command
      ->add_option("--force-cost", weights.force,
                   "Cost of each newton that the hand needs against a fit or a weight")
      ->capture_default_str();
  command
      ->add_option(
          "--hand-time-cost", weights.hand_time,
          "Cost of each second that the hand takes, estimated by MODAPTS; it counts turns, "
          "changes, reach and force once more")
      ->capture_default_str();
  command
      ->add_option("--orders", options->plan.most_orders, "How many of the best orders are given")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--front", options->plan.gives_front,
                    "Give all orders found of which none is better in everything (Pareto front)");
  command
      ->add_option("--time", options->time_s,
                   "End the search for orders after so many seconds; without it, the same file and "
                   "options give the same plan")
      ->check(CLI::PositiveNumber);
  command->add_option("-o,--output", options->output,
                      "File to write: .json, which hvas assemble --plan follows, .html or .pdf");
  command->add_flag("--force", options->is_replaced, "Replace an existing file");
  command->add_option("--seed", options->run.seed, "Draws the actual sizes of the fits")
      ->capture_default_str();
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
