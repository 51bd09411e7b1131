#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "studio/event_bus.h"
#include "studio/hand_rack.h"
#include "studio/history.h"
#include "studio/json.h"
#include "studio/live_run.h"
#include "studio/open_scene.h"
#include "studio/scene_observer.h"

namespace hvas::studio {

/** The open scene and its live run, which a change of the scene, of the hands or of the operator
 replaces by another one. Any thread may call any function, except that Show() and Restart() are for
 the worker thread, and TakeStatus() for one thread. The mutex is not held while an observer or a
 listener is called, nor while the threads of a run end. */
class LiveScene {
 public:
  struct Options {
    std::uint64_t seed{1};            ///< Any number: the simulated person's hand follows from it.
    double rate_hz{1000};             ///< X4 asks for 1 kHz.
    haptics::PaperGuidance guidance;  ///< See HandPurpose.
    LoopClock* clock{&MachineClock()};  ///< Clock of all runs.
  };

  LiveScene(const Options& options, EventBus* events) : options_(options), events_(events) {}

  /** Sets the observers, in the order in which they are called. @pre Show() has not been called. */
  void SetObservers(std::vector<SceneObserver*> observers) { observers_ = std::move(observers); }

  /** Ends the run, and begins one of a scene. Reports by the event "scene", or by "placement" of
   all parts where the scene is the same, and by "step".
   @param state  Without parts: all parts lie on the table.
   @param has_person  The simulated person works.
   @param why  Reason for the change of scene, for people; empty: a file was opened. */
  void Show(const std::shared_ptr<const OpenScene>& scene, const LiveState& state, bool has_person,
            const std::string& why = "");

  /** Begins another run of the scene from the present state. Reports by the event "demo" as well.
   Does nothing without a run. */
  void Restart(bool has_person);

  /** Ends the run; the state stays. */
  void EndRun();

  /** Switches the forces off, or on, in this run and in those that follow. */
  void SetForcesOff(bool is_off);

  [[nodiscard]] bool forces_off() const { return forces_off_.load(); }

  /** Whether the simulated person works. */
  [[nodiscard]] bool is_demo() const { return is_demo_.load(); }

  /** Null while nothing is open. */
  [[nodiscard]] std::shared_ptr<const OpenScene> scene() const;

  /** The open scene. Errors: kNotFound while nothing is open. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> FindScene() const;

  [[nodiscard]] LiveState state() const { return MakeSnapshot().state; }

  /** Scene and state of the same moment. */
  [[nodiscard]] SceneSnapshot MakeSnapshot() const;

  /** Snapshot for SavedWork, in which a held part is where it was before it was taken. */
  [[nodiscard]] SceneSnapshot MakeRestingSnapshot() const;

  [[nodiscard]] LiveFrame frame() const;

  /** Status of the run's loops in the last full second; see LiveRun::TakeStatus(). */
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  /** Makes the event "step" of docs/protocol.md; null while nothing is open. */
  [[nodiscard]] Json DescribeStep() const;

  [[nodiscard]] bool is_holding() const;

  /** Finds what LiveRun::FindOldestInput() finds; none between two runs. */
  [[nodiscard]] std::optional<std::int64_t> FindOldestInput() const;

  [[nodiscard]] LoopClock& clock() const { return *options_.clock; }

  /** Checks that nobody works on the scene, and that all its parts are ready. Errors: without a
   scene, while parts are prepared, while the simulated person works, or while a hand holds a part.
   */
  [[nodiscard]] Result<void> CheckIdle() const;

  /** Null while nothing is open, and between two runs. */
  [[nodiscard]] std::shared_ptr<LiveRun> run() const;

  /** The run, for a command to a hand. Errors: without a scene, while the simulated person works,
   and between two runs. */
  [[nodiscard]] Result<std::shared_ptr<LiveRun>> FindRunForHands() const;

 private:
  [[nodiscard]] LiveListeners MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                            const LiveOptions& live);
  void HandleEvent(const simulation::SimulationEvent& event);
  void HandleHold(const simulation::SimulationEvent& event);
  void HandleStep(const OpenScene& scene, std::size_t step, bool has_person);
  void PublishPlacements() const;
  /** Checks that there is a scene on which the simulated person does not work.
   @pre mutex_ is locked. */
  [[nodiscard]] Result<void> CheckOpen() const;

  const Options options_;
  EventBus* const events_;
  std::vector<SceneObserver*> observers_;
  std::atomic<bool> forces_off_{false};
  std::atomic<bool> is_demo_{false};

  mutable std::mutex mutex_;  ///< Protects what follows.
  std::shared_ptr<const OpenScene> scene_;
  std::shared_ptr<LiveRun> run_;
  LiveState resting_;  ///< State between the end of one run and the begin of the next.
  std::array<std::optional<SceneSnapshot>, HandRack::kMaxHands> before_take_;  ///< Indexed by hand.
  LiveFrame frame_;
};

}  // namespace hvas::studio
