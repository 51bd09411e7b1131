#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "assembly/plan_order.h"
#include "simulation/model.h"

namespace hvas::app {

/** A plan with the times that it took. */
struct PlanReport {
  const simulation::Model* model{nullptr};
  const assembly::OrderPlan* plan{nullptr};
  orders::OrderWeights weights;
  double preparation_s{0};
  double planning_s{0};
};

/** The moves, what has to come before what and why, the best orders with what they count, the parts
 that are left out, and the steps as --plan of `hvas assemble` reads them. Every number's name ends
 in its unit. */
[[nodiscard]] nlohmann::ordered_json MakePlanJson(const PlanReport& report);

/** The best order as a table, one line a move, and what others cost. */
void PrintPlanTable(const PlanReport& report);

/** A page with the same, which needs nothing else. */
[[nodiscard]] std::string MakePlanPage(const PlanReport& report);

}  // namespace hvas::app
