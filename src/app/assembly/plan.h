#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/assembly/run_command.h"
#include "assembly/plan_order.h"

namespace CLI {
class App;
}

namespace hvas::app {

struct PlanCommandOptions : RunCommandOptions {
  assembly::PlanOptions plan;
  OrderChoice order;
  std::vector<std::string> before;  ///< Names by two: the first part before the second.
  double time_s{0};                 ///< The search ends after it; 0: when its tries are over.
  std::filesystem::path output;     ///< .json or .html; empty: none.
  bool is_replaced{false};          ///< The output may replace a file.
};

/** Finds orders of assembly of low cost, and prints the best one, or all as one JSON document.
 @returns The exit status: 0 when the order has every part, 1 on an error, 2 when one is left out.
 */
[[nodiscard]] int RunPlan(const PlanCommandOptions& options);

/** Adds `hvas plan` to the command line; `status` receives what RunPlan returns. */
void AddPlan(CLI::App* app, int* status);

}  // namespace hvas::app
