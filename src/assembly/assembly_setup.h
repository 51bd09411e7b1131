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

/** The hands, and the simulation of a model in which they work: what the setup of each kind of run
 has. It stays where it is: the executors hold on to its parts. */
class RunSetup {
 public:
  /** @param hands  One to haptics::kMaxHands, as MakeHand gives them. */
  RunSetup(std::shared_ptr<const simulation::Model> model, std::vector<Hand> hands);
  RunSetup(const RunSetup&) = delete;
  RunSetup& operator=(const RunSetup&) = delete;
  virtual ~RunSetup() = default;

  [[nodiscard]] const std::vector<Hand>& hands() const { return hands_; }

  [[nodiscard]] simulation::Simulation& simulation() { return *simulation_; }

  [[nodiscard]] virtual simulation::PartRun& part_run() = 0;

  /** An execution for simulation::RunLockstep or RunRealtime, which ends when all parts have had
   their turn or the limit is reached. @param limit_s  Of session time [s]. */
  [[nodiscard]] simulation::Execution MakeExecution(double limit_s);

 protected:
  /** What does the tasks, by hand. */
  [[nodiscard]] simulation::TaskOperators ListMovers() const;

 private:
  std::vector<Hand> hands_;
  std::unique_ptr<simulation::Simulation> simulation_;
};

/** An assembly that has not begun: the hands, the simulation of the model, and the results of each
 part. RunAssembly uses it; a program that needs more control of a run (another sink, only some
 steps, a physics loop that is late) uses it directly:

   AssemblySetup setup(model, std::move(hand), &watch);
   setup.run().Only(step, 1);
   simulation::Execution execution = setup.MakeExecution(60);
   execution.is_done = [&] { return setup.run().is_done() || watch.is_seated(); };
   simulation::RunLockstep(execution);
 */
class AssemblySetup final : public RunSetup {
 public:
  /** @param hands  One to haptics::kMaxHands, as MakeHand gives them.
   @param downstream  Receives what the loops produce after the run has processed it; may be null. A
   session::SessionRecorder among it is to begin with simulation() before the loops run. */
  AssemblySetup(std::shared_ptr<const simulation::Model> model, std::vector<Hand> hands,
                simulation::Sink* downstream);

  /** A setup with one hand. */
  AssemblySetup(std::shared_ptr<const simulation::Model> model, Hand hand,
                simulation::Sink* downstream);

  [[nodiscard]] simulation::AssemblyRun& run() { return run_; }

  [[nodiscard]] simulation::PartRun& part_run() override { return run_; }

 private:
  simulation::AssemblyRun run_;
};

/** A recorder for sessions with a model; its meta says which model it is (session::MakeModelMeta).
 @param further  Meta of the caller's own. Errors: those of record::Recorder::Create. */
[[nodiscard]] Result<std::unique_ptr<record::Recorder>> MakeRecorder(
    const simulation::Model& model, const record::RecorderOptions& options,
    const record::Meta& further = {});

}  // namespace hvas::assembly
