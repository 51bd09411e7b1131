#include "app/assembly/planned_model.h"

#include <utility>

#include <CLI/CLI.hpp>

#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "base/clock.h"

namespace hvas::app {
namespace {

/** Makes the order of the model, which is that of the plan that is followed, the only one. */
Result<void> KeepModelsOrder(const simulation::Model& model, const assembly::PlanOptions& options,
                             assembly::OrderPlan* plan) {
  std::vector<product::OccurrenceId> parts;
  for (const orders::FreeMove& move : plan->rules.moves) {
    parts.push_back(move.parts.front());
  }
  auto checked = assembly::CheckOrder(model, plan->rules, parts, options);
  if (!checked) {
    return Unexpected(checked.error());
  }
  if (checked->order) {
    plan->search.orders = {std::move(*checked->order)};
    plan->statics.clear();
    if (checked->statics) {
      plan->statics.push_back(std::move(*checked->statics));
    }
  }
  return {};
}

assembly::PlanOptions MakePlanOptions(const PlanCommandOptions& options,
                                      const std::stop_token& stop) {
  assembly::PlanOptions plan = options.plan;
  for (std::size_t i = 0; i + 1 < options.before.size(); i += 2) {
    plan.before.emplace_back(options.before[i], options.before[i + 1]);
  }
  if (options.time_s > 0) {
    plan.time = std::chrono::duration<double>(options.time_s);
  }
  if (!options.order.plan.empty()) {
    constexpr std::chrono::milliseconds kNoSearch{1};  // The order is there already.
    plan.time = kNoSearch;
    plan.most_orders = 1;
  }
  plan.stop = stop;
  plan.progress = MakeProgress(!IsShown(options));
  return plan;
}

}  // namespace

tl::expected<PlannedModel, int> PlanModel(const PlanCommandOptions& options, const EndWatch& end) {
  PreparationProgress progress;
  auto model = PrepareRun(options, options.order, end.stop(), &progress);
  if (!model) {
    return tl::unexpected(ReportUnprepared(options, progress, model.error()));
  }
  const std::int64_t prepared_ns = MonotonicNs();
  const assembly::PlanOptions plan_options = MakePlanOptions(options, end.stop());
  auto plan = assembly::PlanOrder(**model, plan_options);
  if (IsShown(options)) {
    ShowProgress("order of least cost", 1);
  }
  if (plan && !options.order.plan.empty()) {
    if (const auto kept = KeepModelsOrder(**model, plan_options, &*plan); !kept) {
      return tl::unexpected(ReportFailure(kept.error()));
    }
  }
  if (!plan) {
    return tl::unexpected(ReportFailure(plan.error()));
  }
  return PlannedModel{std::move(*model), std::move(*plan),
                      1e-9 * static_cast<double>(prepared_ns - progress.start_ns),
                      1e-9 * static_cast<double>(MonotonicNs() - prepared_ns)};
}

void AddOrderOptions(CLI::App* command, PlanCommandOptions* options) {
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
  orders::OrderWeights& weights = options->plan.weights;
  command->add_option("--turn-cost", weights.turn, "Cost of turning the product")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--direction-cost", weights.direction_change,
                   "Cost of a part that comes from another direction than the one before it")
      ->check(NotNegative())
      ->capture_default_str();
  command->add_option("--tool-cost", weights.tool_change, "Cost of a change of tool")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--loose-cost", weights.loose, "Cost of a part that nothing holds when it comes")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--cramped-cost", weights.cramped,
                   "Cost of a fastener that comes when parts stand where its tool turns")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--reach-cost", weights.reach,
                   "Cost of each metre by which the hand goes in among the parts that are there")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--force-cost", weights.force,
                   "Cost of each newton that the hand needs against a fit or a weight")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option(
          "--hand-time-cost", weights.hand_time,
          "Cost of each second that the hand takes, estimated by MODAPTS; it counts turns, "
          "changes, reach and force once more")
      ->check(NotNegative())
      ->capture_default_str();
  command
      ->add_option("--time", options->time_s,
                   "End the search for orders after so many seconds; without it, the same file and "
                   "options give the same plan")
      ->check(Positive());
  command->add_option("--seed", options->run.seed, "Draws the actual sizes of the fits")
      ->capture_default_str();
}

}  // namespace hvas::app
