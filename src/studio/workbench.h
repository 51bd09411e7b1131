#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/job_thread.h"
#include "base/result.h"
#include "studio/hand_rack.h"
#include "studio/history.h"
#include "studio/kept_work.h"
#include "studio/live_run.h"
#include "studio/live_trial.h"
#include "studio/paths.h"
#include "studio/recording.h"
#include "studio/recording_shelf.h"
#include "studio/scene_builder.h"

namespace hvas::studio {

using Json = nlohmann::ordered_json;

struct WorkbenchOptions {
  SceneBuilder::Options scenes;
  std::filesystem::path recordings_folder;  ///< Empty: nothing can be recorded.
  std::filesystem::path work_file;  ///< Keeps KeptWork, as it goes on; empty: it is not kept.
  double rate_hz{1000};             ///< X4 asks for 1 kHz.
};

/** What is on the bench: the product that is open, the run of it, and what can be undone. All
 functions may be called by any thread and return at once, but Stop; slow work is done by a thread
 of its own, in the order in which it was asked for, and told of by events (docs/protocol.md). */
class Workbench {
 public:
  explicit Workbench(WorkbenchOptions options);
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /** Called with every event and every frame, by any thread; to be set before anything is opened.
   */
  std::function<void(Json)> on_event;
  std::function<void()> on_frame;

  /** Ends what runs, and drops what was asked for and has not begun; nothing is told of after it.
   */
  void Stop();

  /** @param name  As people call it. */
  void Open(const std::filesystem::path& file, const std::string& name);
  /** The product of a work that was kept, as far as it had come; where it is not the same product
   any more, it is opened anew. Told of by the event "resumed". */
  void Resume(const KeptWork& work);
  void Cancel();

  /** For hands that follow a pointer. @returns where the hand goes to. */
  [[nodiscard]] Result<spatial::Pose> Take(std::size_t hand, product::OccurrenceId id);
  void Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);
  [[nodiscard]] Result<void> Release(std::size_t hand);

  /** One hand or two. */
  [[nodiscard]] Result<void> SetHandCount(std::size_t count);
  /** Puts a device into a hand, or HandRack::kPointer; told of by the event "hands" or "failed". */
  [[nodiscard]] Result<void> UseDevice(std::size_t hand, const std::string& address, double scale);
  /** Told of by the event "devices". */
  void SearchDevices();
  [[nodiscard]] Json devices() const;
  [[nodiscard]] Json hands() const;

  void SetForcesOff(bool is_off);

  [[nodiscard]] bool forces_off() const { return forces_off_.load(); }

  [[nodiscard]] Result<void> SetDemo(bool is_on);
  [[nodiscard]] Result<void> DoNext();
  [[nodiscard]] Result<void> Undo();
  [[nodiscard]] Result<void> Redo();
  [[nodiscard]] Result<void> Reset();

  /** Records the work on this scene from now on; nothing may be in a hand. Told of by the event
   "recording". */
  [[nodiscard]] Result<void> StartRecording(const std::string& name);
  [[nodiscard]] Result<void> StopRecording();
  /** What is being recorded; null where nothing is. */
  [[nodiscard]] Json recording() const;

  [[nodiscard]] RecordingShelf& shelf() { return shelf_; }

  [[nodiscard]] Result<void> RenameRecording(const std::string& id, const std::string& name);

  /** Not what is being recorded. */
  [[nodiscard]] Result<void> DeleteRecording(const std::string& id);

  /** Begins a trial of a study on what was opened: the parts before its part are in their place,
   all others on the table, in a scene of its own whatever came before it, so that no scene tells
   two conditions apart. Told of by the event "trial_begun" or "trial_failed", which are not for
   clients; then the functions below know of it. */
  void BeginTrial(const LiveTrial::Plan& plan);
  /** Ends its run, and then tells the event "trial_over". */
  void EndTrial();
  [[nodiscard]] std::shared_ptr<LiveTrial> trial() const;
  [[nodiscard]] product::OccurrenceId trial_part() const;
  /** Mates of its part with those in their place. */
  [[nodiscard]] std::vector<product::MateId> trial_constraints() const;

  /** A change of the product: compiles a model of it aside and swaps it in. */
  [[nodiscard]] Result<void> Change(const Edit& edit);

  /** Null while nothing is open. */
  [[nodiscard]] std::shared_ptr<const OpenScene> scene() const;

  /** Of the parts of what is open. */
  [[nodiscard]] const PathLog& paths() const { return paths_; }

  [[nodiscard]] Sweeper& sweeper() { return sweeper_; }

  [[nodiscard]] LiveState state() const { return Look().state; }

  /** Both of one moment. */
  [[nodiscard]] SceneNow Look() const;
  [[nodiscard]] LiveFrame frame() const;
  /** The events that whoever comes late has missed and still needs. */
  [[nodiscard]] std::vector<Json> NewsForLatecomer() const;
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  [[nodiscard]] bool is_demo() const { return is_demo_.load(); }

 private:
  void Post(std::function<void()> job);
  void PostOpen(std::function<void()> job);
  /** @param kept  To go on from; null: nothing. */
  void DoOpen(const std::filesystem::path& file, const std::string& name, const KeptWork* kept);
  /** What was kept of a scene that has been opened; where there is nothing to go on from, the scene
   as it is. */
  [[nodiscard]] SceneNow GoOnFrom(const KeptWork& kept,
                                  const std::shared_ptr<const OpenScene>& opened);
  void DoChange(const Edit& edit);
  /** Soon: what it has come to by then. */
  void KeepWork();
  void DoKeepWork();
  /** As of KeptWork: a part in a hand is where it was before. */
  [[nodiscard]] SceneNow LookAtRest() const;
  void EndRun();
  void DoBeginTrial(const LiveTrial::Plan& plan);
  void DoEndTrial();
  /** A scene with the part's fit; compiled once. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> FindTrialScene(
      const LiveTrial::Plan& plan);
  [[nodiscard]] Result<void> GoTo(History::Direction direction);
  [[nodiscard]] cad::ProgressFn TellProgressOf(const std::string& name) const;
  /** @param why  It is another scene than before, in words; empty: it was opened. */
  void Show(const std::shared_ptr<const OpenScene>& scene, const LiveState& state, bool has_person,
            const std::string& why = "");
  void Restart(bool has_person);
  [[nodiscard]] LiveListeners MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                            const LiveOptions& live);
  void HandleEvent(const OpenScene& scene, const simulation::SimulationEvent& event);
  void HandleStep(const OpenScene& scene, std::size_t step, bool has_person);
  void TellOfStep(const OpenScene& scene, std::size_t step) const;
  void Tell(Json event) const;
  void TellOfHistory() const;
  void TellOfPlacements() const;
  /** That was done, and can be undone. */
  void Remember(SceneNow before, const std::string& what);
  void TellOfHands() const;
  void DoStartRecording(const std::filesystem::path& file, const std::string& name);
  void TellOfRecording(Json recording) const;
  void FinishRecording();
  /** Finishes the recording of now if it has failed, so that all clients learn of it. */
  void EndFailedRecording();
  /** Errors: somebody is at work. */
  [[nodiscard]] Result<void> CheckHands() const;
  void RestartWithHands();
  void HandleHold(const OpenScene& scene, const simulation::SimulationEvent& event);
  void HandleDevice(const simulation::SimulationEvent& event);
  /** Errors: nothing is open, or somebody is at work. */
  [[nodiscard]] Result<void> CheckIdle() const;
  /** The same of one hand: the other may hold something. */
  [[nodiscard]] Result<std::shared_ptr<LiveRun>> RunForHand(std::size_t hand) const;

  WorkbenchOptions options_;
  std::atomic<bool> forces_off_{false};
  std::atomic<bool> is_demo_{false};
  std::atomic<bool> ends_demo_after_step_{false};
  bool has_stopped_{false};
  SceneBuilder builder_;  ///< The worker's own.

  mutable std::mutex mutex_;  ///< Protects what follows.
  std::shared_ptr<const OpenScene> scene_;
  std::shared_ptr<LiveRun> run_;
  Json failure_;       ///< Of the last file that could not be opened; null: none.
  Json resumed_;       ///< The event, until the work has gone on from there; null: none.
  LiveState resting_;  ///< While one run has ended and the next has not begun.
  std::array<std::optional<SceneNow>, HandRack::kMostHands> before_take_;  ///< By hand.
  LiveFrame frame_;
  std::stop_source opening_;
  std::shared_ptr<Recording> recording_;  ///< Null while nothing is recorded.

  std::shared_ptr<LiveTrial> trial_;  ///< Null while there is none.
  std::size_t trial_step_{0};         ///< Of the sequence: its part's.
  /** By fit; the worker's own. */
  std::map<std::string, std::shared_ptr<const OpenScene>> trial_scenes_;

  History history_;
  HandRack rack_;
  DeviceSearch device_search_;
  PathLog paths_;
  Sweeper sweeper_;
  RecordingShelf shelf_;

  bool can_keep_work_{true};  ///< False once the disk has refused; the keeper's own.
  JobThread keeper_;          ///< Writes the work to disk.
  JobThread worker_;          ///< The last member: the first that ends.
};

}  // namespace hvas::studio
