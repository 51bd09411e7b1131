#pragma once

#include <cstddef>
#include <optional>

#include "simulation/simulation.h"
#include "studio/history.h"
#include "studio/live_run.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Part of the workbench that follows the runs of a LiveScene. Each function does nothing unless it
 is overridden, and is called while the scene holds no lock. */
class SceneObserver {
 public:
  SceneObserver() = default;
  SceneObserver(const SceneObserver&) = delete;
  SceneObserver& operator=(const SceneObserver&) = delete;
  virtual ~SceneObserver() = default;

  /** Sets options of a run that is about to begin. The previous run has ended. Called on the worker
   thread. */
  virtual void ConfigureRun(const OpenScene& /*scene*/, LiveOptions* /*live*/) {}

  /** Handles the begin of a run. Called on the worker thread. */
  virtual void OnRunBegun() {}

  /** Handles an event of the simulation. Called on the physics thread. */
  virtual void OnEvent(const simulation::SimulationEvent& /*event*/) {}

  /** Handles that a hand of a person has taken or dropped a part. Called on the physics thread.
   @param before  Snapshot before the part was taken; none for a part that has just been taken. */
  virtual void OnHold(const simulation::SimulationEvent& /*event*/,
                      const std::optional<SceneSnapshot>& /*before*/) {}

  /** Handles a change of a part's placement. Called on the physics thread. */
  virtual void OnPlacement() {}

  /** Handles that a step of the sequence is the next one. Called on the physics thread.
   @param has_person  Whether the simulated person works in this run. */
  virtual void OnStep(const OpenScene& /*scene*/, std::size_t /*step*/, bool /*has_person*/) {}

  /** Handles that the simulated person has taken a part out, or tried to. Called on the physics
   thread. @param is_last  The plan of the disassembly has no further removal. */
  virtual void OnRemoval(bool /*is_last*/) {}

  /** Handles a new frame. Called on the publish thread. */
  virtual void OnFrame(const simulation::Frame& /*frame*/) {}
};

}  // namespace hvas::studio
