#pragma once

#include <functional>
#include <memory>
#include <string>

#include "assembly/run_assembly.h"
#include "base/result.h"
#include "simulation/disassembly_plan.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** Plans how a model is taken apart, or how one part is got out of it.
 Errors: kNotFound and kInvalid for a name that does not mean one part, kInvalid for the base,
 kUnsupported for a part that cannot come out, with what is in its way.
 @param part  Name, path or id of the part to get out; empty: all of them.
 @param progress  Called by the calling thread; may be null. */
[[nodiscard]] Result<simulation::DisassemblyPlan> PlanDisassembly(
    const simulation::Model& model, const std::string& part,
    const std::function<void(double fraction)>& progress = nullptr);

/** Results of a disassembly. */
struct DisassemblyOutcome {
  /** Its parts are those of the plan in its order, and after them those that cannot come out; the
   reason is empty for a part that has come out. */
  RunOutcome run;

  /** Every part of the plan has come out, and none was stuck. */
  [[nodiscard]] bool is_complete() const;
};

/** Takes a model apart by a plan: all parts are in place at the beginning, and a simulated person,
 or the user of a device, draws one after the other out and puts it down on the table. The run is
 recorded like an assembly. Errors: those of RunAssembly; kInvalid for more than one hand.
 @param model  As PrepareModel gives it. @pre model != nullptr. */
[[nodiscard]] Result<DisassemblyOutcome> RunDisassembly(
    const std::shared_ptr<const simulation::Model>& model, const simulation::DisassemblyPlan& plan,
    const RunOptions& options);

}  // namespace hvas::assembly
