#pragma once

#include "app/assembly/left_out.h"
#include "app/assembly/run_report.h"
#include "simulation/model.h"

namespace hvas::app {

/** One JSON document on stdout; every number's name ends in its unit. */
void PrintAssemblyJson(const simulation::Model& model, const SessionReport& report,
                       const LeftOut& left_out);

/** One line a part, what was left out and why, and how long everything took. */
void PrintAssemblyTable(const simulation::Model& model, const SessionReport& report);

}  // namespace hvas::app
