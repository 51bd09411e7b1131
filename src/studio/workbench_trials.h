#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/job_thread.h"
#include "base/result.h"
#include "studio/event_bus.h"
#include "studio/live_scene.h"
#include "studio/live_trial.h"
#include "studio/scene_builder.h"
#include "studio/scene_observer.h"
#include "studio/workbench_edits.h"

namespace hvas::studio {

/** Trials of a study on the open product. Any thread may call any function; all return at once, and
 leave slow work to the worker. The events of trials are for the study desk; clients do not get
 them. */
class WorkbenchTrials final : public SceneObserver {
 public:
  /** Parts of the workbench on which trials run; `builder` is used by the worker alone. */
  struct Parts {
    SceneBuilder* builder{nullptr};
    LiveScene* live{nullptr};
    WorkbenchEdits* edits{nullptr};
    EventBus* events{nullptr};
    JobThread* worker{nullptr};
  };

  /** @param period_s  Period of the ticks [s]. */
  WorkbenchTrials(const Parts& parts, double period_s) : parts_(parts), period_s_(period_s) {}

  /** Begins a trial: parts that precede the trial's part in the sequence are in their place, all
   others on the table. Each trial has a new scene, so that a scene reveals nothing of the
   condition. Reports by the event "trial_begun" or "trial_failed"; from "trial_begun" on, the
   functions below describe the trial. */
  void Begin(const LiveTrial::Plan& plan);

  /** Ends the trial's run. Reports by the event "trial_over". */
  void End();

  /** Null while there is no trial. */
  [[nodiscard]] std::shared_ptr<LiveTrial> trial() const;

  /** Part that the participant assembles; invalid while there is no trial. */
  [[nodiscard]] product::OccurrenceId part() const;

  /** Lists the mates that the participant has to pick; see study::ListPickedConstraints(). */
  [[nodiscard]] std::vector<product::MateId> ListConstraints() const;

 private:
  /** The trial, its scene, and the index of its part's step in the sequence. */
  struct Current {
    std::shared_ptr<LiveTrial> trial;
    std::shared_ptr<const OpenScene> scene;
    std::size_t step{0};
  };

  void ConfigureRun(const OpenScene& scene, LiveOptions* live) override;
  void DoBegin(const LiveTrial::Plan& plan);
  void DoEnd();
  /** Makes the trial that a plan asks for. Errors: without a scene, those of the fit, of the part,
   and of LiveTrial::Make. */
  [[nodiscard]] Result<Current> Make(const LiveTrial::Plan& plan);
  /** Finds the scene with the part's fit in the trial; it is compiled once for each fit. The
   pair of a trial is drawn after that. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> FindScene(const LiveTrial::Plan& plan);

  const Parts parts_;
  const double period_s_;
  /** Scenes of trials, by product and fit; used by the worker thread only. */
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const OpenScene>> scenes_;

  mutable std::mutex mutex_;  ///< Protects what follows.
  Current current_;           ///< Its trial is null while there is none.
};

}  // namespace hvas::studio
