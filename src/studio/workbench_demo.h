#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

#include "base/job_thread.h"
#include "base/result.h"
#include "simulation/disassembly_plan.h"
#include "studio/live_scene.h"
#include "studio/scene_observer.h"
#include "studio/workbench_edits.h"

namespace hvas::studio {

/** Demonstration: the simulated person goes on with the assembly, to its end or by one step, or
 gets a part out of it. Any thread may call any function; all return at once, and leave slow work to
 the worker. */
class WorkbenchDemo final : public SceneObserver {
 public:
  /** Called on the worker thread. */
  using PlannedFn = std::function<void(const Result<simulation::DisassemblyPlan>& plan)>;

  WorkbenchDemo(LiveScene* live, WorkbenchEdits* edits, JobThread* worker)
      : live_(live), edits_(edits), worker_(worker) {}

  /** Reports by the event "demo". Errors: those of LiveScene::CheckIdle. */
  [[nodiscard]] Result<void> Start();

  /** Demonstrates the next step alone. Errors: those of Start(). */
  [[nodiscard]] Result<void> DoNext();

  /** Plans how a part gets out from between those that are in their place. Errors: those of
   LiveScene::CheckIdle; of the plan: kNotFound for no such part, kInvalid for the base and for a
   part that is not in its place, kUnsupported for one that cannot come out, with the reason. */
  [[nodiscard]] Result<void> PlanRemoval(product::OccurrenceId id, const PlannedFn& done);

  /** Has the simulated person get a part out, and what has to come out first. Reports by the event
   "demo", too. Errors: those of PlanRemoval(). */
  [[nodiscard]] Result<void> TakeOut(product::OccurrenceId id, const PlannedFn& done);

  /** Ends the demonstration after the step in progress. Reports by the event "demo". */
  void Stop();

 private:
  void ConfigureRun(const OpenScene& scene, LiveOptions* live) override;
  void OnStep(const OpenScene& scene, std::size_t step, bool has_person) override;
  void OnRemoval(bool is_last) override;
  [[nodiscard]] Result<simulation::DisassemblyPlan> MakePlan(product::OccurrenceId id) const;
  void EndRun();

  LiveScene* const live_;
  WorkbenchEdits* const edits_;
  JobThread* const worker_;
  std::atomic<bool> ends_after_step_{false};
  std::atomic<bool> is_taking_out_{false};
  /** Plan of the run that is about to begin; used by the worker thread only. */
  std::shared_ptr<const simulation::DisassemblyPlan> plan_;
};

}  // namespace hvas::studio
