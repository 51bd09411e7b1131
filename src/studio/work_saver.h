#pragma once

#include <filesystem>

#include "base/job_thread.h"
#include "studio/event_bus.h"
#include "studio/live_scene.h"
#include "studio/scene_observer.h"
#include "studio/workbench_notes.h"
#include "studio/workbench_trials.h"

namespace hvas::studio {

/** Saves the work on the open product, except in trials, to a file after each change, on a thread
 of its own. Stop() and BackUp() are each for one thread at a time. */
class WorkSaver final : public SceneObserver {
 public:
  /** What is saved: the state of a scene with its notes, except in trials. */
  struct Sources {
    const LiveScene* live{nullptr};
    const WorkbenchTrials* trials{nullptr};
    const WorkbenchNotes* notes{nullptr};
  };

  /** @param file  File of SavedWork; empty: nothing is saved. */
  WorkSaver(std::filesystem::path file, const Sources& sources, const EventBus* events);

  /** Moves the saved work to a backup file, as the work on another product follows. */
  void BackUp() const;

  /** Schedules a save of the work in its state at that time. */
  void ScheduleSave();

  /** Saves the work a last time, and ends the thread; does nothing when it is called again. */
  void Stop();

 private:
  void OnRunBegun() override { ScheduleSave(); }

  void OnPlacement() override { ScheduleSave(); }

  void OnStep(const OpenScene& scene, std::size_t step, bool has_person) override;
  /** Reports by the event "failed" when writing fails for the first time. */
  void Save();

  const std::filesystem::path file_;
  const Sources sources_;
  const EventBus* const events_;
  bool can_save_{true};  ///< False once writing has failed; used by one thread at a time.
  bool has_stopped_{false};
  JobThread thread_;  ///< Last member, so that it ends before the others are destroyed.
};

}  // namespace hvas::studio
