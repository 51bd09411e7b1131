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
#include "studio/live_run.h"
#include "studio/live_trial.h"
#include "studio/paths.h"
#include "studio/recording.h"
#include "studio/recording_shelf.h"
#include "studio/saved_work.h"
#include "studio/scene_builder.h"

namespace hvas::studio {

using Json = nlohmann::ordered_json;

struct WorkbenchOptions {
  SceneBuilder::Options scenes;
  std::filesystem::path recordings_folder;  ///< Empty: recording is switched off.
  std::filesystem::path work_file;  ///< File that SavedWork is saved to after changes; empty: none.
  double rate_hz{1000};             ///< X4 asks for 1 kHz.
};

/** The open product, its live run, and the undo list. Any thread may call any function. All but
 Stop() return at once: slow work is queued for a worker thread, which reports by events
 (docs/protocol.md). */
class Workbench {
 public:
  explicit Workbench(WorkbenchOptions options);
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /** Callbacks for every event and every new frame, on any thread; to be set before a file is
   opened. */
  std::function<void(Json)> on_event;
  std::function<void()> on_frame;

  /** Ends the run and drops the queue; no event or frame follows. */
  void Stop();

  /** Opens a file. @param name  Display name. */
  void Open(const std::filesystem::path& file, const std::string& name);
  /** Opens the product of saved work, applies its edits and restores its state; where the file
   holds another product by now, it is opened as new. Reports by the event "resumed". */
  void Resume(const SavedWork& work);
  void Cancel();

  /** Takes a part with a hand that follows the pointer. @returns the pose X_WH that the hand
   moves to. */
  [[nodiscard]] Result<spatial::Pose> Take(std::size_t hand, product::OccurrenceId id);
  void Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);
  [[nodiscard]] Result<void> Release(std::size_t hand);

  /** Sets the number of hands: 1 or 2. */
  [[nodiscard]] Result<void> SetHandCount(std::size_t count);
  /** Assigns a device, or HandRack::kPointer, to a hand. Reports by the event "hands" or
   "failed". */
  [[nodiscard]] Result<void> UseDevice(std::size_t hand, const std::string& address, double scale);
  /** Searches for devices. Reports by the event "devices". */
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

  /** Records the work on this scene from now on. Reports by the event "recording". Errors: kInvalid
   while a hand holds a part. */
  [[nodiscard]] Result<void> StartRecording(const std::string& name);
  [[nodiscard]] Result<void> StopRecording();
  /** Description of the recording in progress; null where there is none. */
  [[nodiscard]] Json recording() const;

  [[nodiscard]] RecordingShelf& shelf() { return shelf_; }

  [[nodiscard]] Result<void> RenameRecording(const std::string& id, const std::string& name);

  /** Deletes a recording. Errors: kInvalid for the one in progress; those of RecordingShelf. */
  [[nodiscard]] Result<void> DeleteRecording(const std::string& id);

  /** Begins a trial of a study on the open product: parts that precede the trial's part in the
   sequence are in their place, all others on the table. Each trial has a new scene, so that a scene
   reveals nothing of the condition. Reports by the event "trial_begun" or "trial_failed", which
   clients do not get; from then on the functions below describe the trial. */
  void BeginTrial(const LiveTrial::Plan& plan);
  /** Ends the trial's run. Reports by the event "trial_over". */
  void EndTrial();
  [[nodiscard]] std::shared_ptr<LiveTrial> trial() const;
  [[nodiscard]] product::OccurrenceId trial_part() const;
  /** Mates between the trial's part and parts in their place. */
  [[nodiscard]] std::vector<product::MateId> trial_constraints() const;

  /** Applies an edit: compiles a model of the changed product in the background and swaps it in. */
  [[nodiscard]] Result<void> Change(const Edit& edit);

  /** Null while nothing is open. */
  [[nodiscard]] std::shared_ptr<const OpenScene> scene() const;

  /** Paths of the parts of the open product. */
  [[nodiscard]] const PathLog& paths() const { return paths_; }

  [[nodiscard]] Sweeper& sweeper() { return sweeper_; }

  [[nodiscard]] LiveState state() const { return MakeSnapshot().state; }

  /** Scene and state of the same moment. */
  [[nodiscard]] SceneSnapshot MakeSnapshot() const;
  [[nodiscard]] LiveFrame frame() const;
  /** Events that a client needs which joins later: the present state, in the form of events. */
  [[nodiscard]] std::vector<Json> MakeCatchUpEvents() const;
  [[nodiscard]] std::optional<simulation::LoopStatus> TakeStatus();

  [[nodiscard]] bool is_demo() const { return is_demo_.load(); }

 private:
  void Post(std::function<void()> job);
  void PostOpen(std::function<void()> job);
  /** @param kept  Saved work to resume; null: none. */
  void DoOpen(const std::filesystem::path& file, const std::string& name, const SavedWork* kept);
  /** Restores saved work on a scene that has been opened; where it does not fit, the scene as
   opened. */
  [[nodiscard]] SceneSnapshot RestoreWork(const SavedWork& kept,
                                          const std::shared_ptr<const OpenScene>& opened);
  void DoChange(const Edit& edit);
  /** Schedules a save of the work in its state at that time. */
  void ScheduleSave();
  void DoSaveWork();
  /** Snapshot for SavedWork, in which a held part is where it was before it was taken. */
  [[nodiscard]] SceneSnapshot MakeRestingSnapshot() const;
  void EndRun();
  void DoBeginTrial(const LiveTrial::Plan& plan);
  void DoEndTrial();
  /** Scene with the part's fit in the trial; compiled once for each fit. */
  [[nodiscard]] Result<std::shared_ptr<const OpenScene>> FindTrialScene(
      const LiveTrial::Plan& plan);
  [[nodiscard]] Result<void> GoTo(History::Direction direction);
  [[nodiscard]] cad::ProgressFn MakeProgressListener(const std::string& name) const;
  /** @param why  Reason for the change of scene, for people; empty: a file was opened. */
  void Show(const std::shared_ptr<const OpenScene>& scene, const LiveState& state, bool has_person,
            const std::string& why = "");
  void Restart(bool has_person);
  [[nodiscard]] LiveListeners MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                            const LiveOptions& live);
  void HandleEvent(const OpenScene& scene, const simulation::SimulationEvent& event);
  void HandleStep(const OpenScene& scene, std::size_t step, bool has_person);
  void PublishStep(const OpenScene& scene, std::size_t step) const;
  void Publish(Json event) const;
  void PublishHistory() const;
  void PublishPlacements() const;
  /** Adds an undo step to the history. */
  void Remember(SceneSnapshot before, const std::string& what);
  void PublishHands() const;
  void DoStartRecording(const std::filesystem::path& file, const std::string& name);
  void PublishRecording(Json recording) const;
  void FinishRecording();
  /** Finishes the recording in progress if writing has failed, and tells all clients. */
  void EndFailedRecording();
  /** Checks whether the hands can be changed. Errors: those of CheckIdle, but none without a
   scene. */
  [[nodiscard]] Result<void> CheckHands() const;
  void RestartWithHands();
  void HandleHold(const OpenScene& scene, const simulation::SimulationEvent& event);
  void HandleDevice(const simulation::SimulationEvent& event);
  /** Checks that nobody works on the scene. Errors: without a scene, while the simulated person
   works, or while a hand holds a part. */
  [[nodiscard]] Result<void> CheckIdle() const;
  /** The run, for a command to one hand that follows the pointer. Errors: without a scene, while
   the simulated person works or the model changes, or for a hand that is missing or has a
 device. */
  [[nodiscard]] Result<std::shared_ptr<LiveRun>> RunForHand(std::size_t hand) const;

  WorkbenchOptions options_;
  std::atomic<bool> forces_off_{false};
  std::atomic<bool> is_demo_{false};
  std::atomic<bool> ends_demo_after_step_{false};
  bool has_stopped_{false};
  SceneBuilder builder_;  ///< Used by the worker thread only.

  mutable std::mutex mutex_;  ///< Protects what follows.
  std::shared_ptr<const OpenScene> scene_;
  std::shared_ptr<LiveRun> run_;
  Json failure_;       ///< Event of the last file that could not be opened; null: none.
  Json resumed_;       ///< Event "resumed", until the next change; null: none.
  LiveState resting_;  ///< State between the end of one run and the begin of the next.
  std::array<std::optional<SceneSnapshot>, HandRack::kMaxHands> before_take_;  ///< Indexed by hand.
  LiveFrame frame_;
  std::stop_source opening_;
  std::shared_ptr<Recording> recording_;  ///< Null while nothing is recorded.

  std::shared_ptr<LiveTrial> trial_;  ///< Null while there is none.
  std::size_t trial_step_{0};         ///< Index of its part's step in the sequence.
  /** Scenes of trials, by fit; used by the worker thread only. */
  std::map<std::string, std::shared_ptr<const OpenScene>> trial_scenes_;

  History history_;
  HandRack rack_;
  DeviceSearch device_search_;
  PathLog paths_;
  Sweeper sweeper_;
  RecordingShelf shelf_;

  bool can_save_work_{true};  ///< False once writing has failed; used by the keeper's thread only.
  JobThread keeper_;          ///< Saves the work to disk.
  JobThread worker_;          ///< Last member, so that it ends before the others are destroyed.
};

}  // namespace hvas::studio
