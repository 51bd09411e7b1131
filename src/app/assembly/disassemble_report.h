#pragma once

#include "app/assembly/run_report.h"
#include "simulation/disassembly_plan.h"
#include "simulation/model.h"

namespace hvas::app {

/** One JSON document on stdout; every number's name ends in its unit. */
void PrintDisassemblyJson(const simulation::Model& model, const simulation::DisassemblyPlan& plan,
                          const SessionReport& report);

/** One line a part, what it waited for, what did not come out and why, and how long everything
 took. */
void PrintDisassemblyTable(const simulation::Model& model, const simulation::DisassemblyPlan& plan,
                           const SessionReport& report);

}  // namespace hvas::app
