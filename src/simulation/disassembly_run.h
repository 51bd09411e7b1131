#pragma once

#include <string>
#include <vector>

#include "simulation/disassembly_plan.h"
#include "simulation/part_run.h"

namespace hvas::simulation {

/** Puts all parts of a simulation into their place. @pre the loops do not run yet. */
void PutAllInPlace(Simulation* simulation);

/** Has a product taken apart by a plan, from the parts that are in place: a simulated person, or
 the user of a device, draws one after the other out along its way and puts it down. A part that
 waits for one which did not come out is not tried. */
class DisassemblyRun final : public PartRun {
 public:
  /** Makes the run; the loops do not run yet.
   @param plan  Plan for the model of the simulation; outlives this object.
   @param mover  What moves the first hand; null: the user of a device, who takes out what
   they like. */
  DisassemblyRun(Simulation* simulation, const DisassemblyPlan* plan, TaskOperator* mover,
                 Sink* downstream);

  void Advance() override;

  /** The part has been drawn out of its place, by at least the way on which it was engaged. */
  [[nodiscard]] bool IsOut(const Removal& removal) const;

 private:
  void OnDropped(const SimulationEvent& dropped) override { (void)dropped; }

  /** Prepares the next removal and gives it to the person; false where they cannot take it now. */
  [[nodiscard]] bool Begin(const Removal& removal);
  [[nodiscard]] bool HasFinished(const Removal& removal) const;
  void Finish(const Removal& removal, const std::string& reason);
  /** A part in the way that has not come out; invalid where there is none. */
  [[nodiscard]] product::OccurrenceId FindWall(const Removal& removal) const;
  [[nodiscard]] std::string ExplainFailure(const Removal& removal) const;
  void FinishAll();

  const DisassemblyPlan& plan_;
  TaskOperator* mover_;
  std::size_t next_{0};
  bool is_busy_{false};
  int finished_before_{0};
};

}  // namespace hvas::simulation
