#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "assembly/hand.h"
#include "base/result.h"
#include "record/recorder.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/simulation.h"

namespace hvas::assembly {

/** One run, put together and not yet begun: the hands, the simulation of the model, and the account
 of each part. RunAssembly is made of it; a program that watches or changes more of a run (another
 sink, only some steps, a physics loop that comes late) takes it apart:

   AssemblySetup setup(model, std::move(hand), &watch);
   setup.run().Only(step, 1);
   simulation::Execution execution = setup.MakeExecution(60);
   execution.is_done = [&] { return setup.run().is_done() || watch.is_seated(); };
   simulation::RunLockstep(execution);

 It stays where it is: the executors hold on to its parts. */
class AssemblySetup {
 public:
  /** @param hands  One or two, as MakeHand gives them.
   @param downstream  Gets what the loops produce, behind the account; may be null. A
   session::SessionRecorder among it is to begin with simulation() before the loops run. */
  AssemblySetup(std::shared_ptr<const simulation::Model> model, std::vector<Hand> hands,
                simulation::Sink* downstream);

  /** A setup with one hand. */
  AssemblySetup(std::shared_ptr<const simulation::Model> model, Hand hand,
                simulation::Sink* downstream);

  [[nodiscard]] const std::vector<Hand>& hands() const { return hands_; }

  [[nodiscard]] simulation::Simulation& simulation() { return *simulation_; }

  [[nodiscard]] simulation::AssemblyRun& run() { return run_; }

  /** An execution for simulation::RunLockstep or RunRealtime, which ends when all parts have had
   their turn or the limit is reached. @param limit_s  Of session time [s]. */
  [[nodiscard]] simulation::Execution MakeExecution(double limit_s);

 private:
  std::vector<Hand> hands_;
  std::unique_ptr<simulation::Simulation> simulation_;
  simulation::AssemblyRun run_;
};

/** A recorder for sessions with a model; its meta says which model it is (session::MakeModelMeta).
 @param further  Meta of the caller's own. Errors: those of record::Recorder::Create. */
[[nodiscard]] Result<std::unique_ptr<record::Recorder>> MakeRecorder(
    const simulation::Model& model, const record::RecorderOptions& options,
    const record::Meta& further = {});

}  // namespace hvas::assembly
