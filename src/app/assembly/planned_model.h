#pragma once

#include <memory>

#include <tl/expected.hpp>

#include "app/assembly/plan.h"
#include "app/end_watch.h"

namespace hvas::app {

/** A model with orders of its assembly, and the times that both took. */
struct PlannedModel {
  std::shared_ptr<const simulation::Model> model;
  assembly::OrderPlan plan;
  double preparation_s{0};
  double planning_s{0};
};

/** Prepares a product and finds orders of its assembly, with progress. Where a plan is to be
 followed (OrderChoice::plan), its order is the only one. Errors are reported; what is returned then
 is the exit status. */
[[nodiscard]] tl::expected<PlannedModel, int> PlanModel(const PlanCommandOptions& options,
                                                        const EndWatch& end);

/** Adds --order, --before, the costs, --time and --seed to a command. */
void AddOrderOptions(CLI::App* command, PlanCommandOptions* options);

}  // namespace hvas::app
