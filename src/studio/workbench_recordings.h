#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <utility>

#include "base/job_thread.h"
#include "base/result.h"
#include "studio/event_bus.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/recording.h"
#include "studio/recording_shelf.h"
#include "studio/scene_observer.h"

namespace hvas::studio {

/** Recordings of the work: the one in progress, which has one scene, and those on the shelf. Any
 thread may call any function; all but Finish() leave slow work to the worker. Those that access the
 disk are called by PostDiskWork(). */
class WorkbenchRecordings final : public SceneObserver {
 public:
  /** @param folder  See RecordingShelf. */
  WorkbenchRecordings(const std::filesystem::path& folder, LiveScene* live, EventBus* events,
                      JobThread* worker);

  /** Records the work on this scene from now on. Reports by the event "recording". Errors: kInvalid
   while a hand holds a part, and while a recording is in progress. */
  [[nodiscard]] Result<void> Start(const std::string& name);

  /** Finishes the recording in progress in the background. Errors: kInvalid where there is none. */
  [[nodiscard]] Result<void> Stop();

  /** Finishes the recording in progress, and waits for its file; does nothing where there is none.
   Reports by the events "recording" and "failed". */
  void Finish();

  /** Description of the recording in progress; null where there is none. */
  [[nodiscard]] Json Describe() const;

  [[nodiscard]] Result<void> Rename(const std::string& id, const std::string& name);

  /** Shares a recording of the open product, or no more; uses the disk. Reports by the event
   "recordings". Errors: those of LiveScene::FindScene and of RecordingShelf::Share. */
  [[nodiscard]] Result<void> Share(const std::string& id, bool is_shared);

  /** Digest of the open product; empty: none is open. */
  [[nodiscard]] std::string FindDigest() const;

  /** Deletes a recording. Errors: kInvalid for the one in progress; those of RecordingShelf. */
  [[nodiscard]] Result<void> Delete(const std::string& id);

  [[nodiscard]] RecordingShelf& shelf() { return shelf_; }

  /** Does some work of the disk on a thread of its own, after what was posted before. */
  void PostDiskWork(std::function<void()> work) {
    disk_.Post([work = std::move(work)](const std::stop_token& /*stop*/) { work(); });
  }

  /** Waits for the disk work that has begun, and does no more. */
  void StopDiskWork() { disk_.Stop(); }

 private:
  void ConfigureRun(const OpenScene& scene, LiveOptions* live) override;
  [[nodiscard]] std::shared_ptr<Recording> recording() const;
  void DoStart(const std::filesystem::path& file, const std::string& name);
  /** Finishes the recording in progress if writing has failed. */
  void FinishFailed();
  void PublishRecording(Json recording) const;

  LiveScene* const live_;
  EventBus* const events_;
  JobThread* const worker_;
  RecordingShelf shelf_;

  mutable std::mutex mutex_;              ///< Protects what follows.
  std::shared_ptr<Recording> recording_;  ///< Null while nothing is recorded.

  JobThread disk_;  ///< The last member: the first that ends.
};

}  // namespace hvas::studio
