#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/job_thread.h"
#include "studio/event_bus.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/paths.h"
#include "studio/saved_work.h"
#include "studio/scene_builder.h"
#include "studio/scene_observer.h"
#include "studio/work_saver.h"
#include "studio/workbench_edits.h"
#include "studio/workbench_notes.h"

namespace hvas::studio {

/** Opens products on the workbench: files, and saved work. Any thread may call any function; all
 return at once, and leave slow work to the worker. */
class SceneOpener final : public SceneObserver {
 public:
  /** Parts of the workbench that another product concerns; `builder` is used by the worker alone.
   */
  struct Parts {
    SceneBuilder* builder{nullptr};
    LiveScene* live{nullptr};
    WorkbenchEdits* edits{nullptr};
    WorkbenchNotes* notes{nullptr};
    PathLog* paths{nullptr};
    WorkSaver* saver{nullptr};
    EventBus* events{nullptr};
    JobThread* worker{nullptr};
  };

  explicit SceneOpener(const Parts& parts) : parts_(parts) {}

  /** When an opened product is shown. */
  enum class When : std::uint8_t {
    kFirstParts,  ///< When its first parts are ready, and again when all are.
    kWhole,       ///< When all its parts are ready.
  };

  /** Opens a file; a file that is being opened is given up. Reports by the events "progress", and
   "scene" or "failed". @param name  Display name. */
  void Open(const std::filesystem::path& file, const std::string& name,
            When when = When::kFirstParts);

  /** Opens the product of saved work, applies its edits and restores its state; where the file
   holds another product by now, it is opened as new. Reports by the event "resumed" as well. */
  void Resume(const SavedWork& work);

  /** Gives up the file that is being opened. */
  void Cancel();

  /** Whether a file is that of the open product, or was asked for last. */
  [[nodiscard]] bool IsInUse(const std::filesystem::path& file) const;

  /** Makes the events that a client needs which joins later: that the last file could not be
   opened, where no other one is open, and that work was resumed, until the next change. */
  [[nodiscard]] std::vector<Json> MakeCatchUpEvents() const;

 private:
  void OnHold(const simulation::SimulationEvent& event,
              const std::optional<SceneSnapshot>& before) override;
  void OnPlacement() override;
  /** Posts a job that opens a file, in place of the one in progress. */
  void Post(const std::filesystem::path& file, std::function<void()> job);
  /** @param kept  Saved work to resume; null: none. */
  void DoOpen(const std::filesystem::path& file, const std::string& name, When when,
              const SavedWork* kept);
  /** Shows a scene, with which the list of edits begins anew.
   @param why  As of LiveScene::Show. */
  void Show(const SceneSnapshot& snapshot, const std::string& why = "");
  /** Shows the scene that waits for it, unless a hand holds a part: then when it lets go. */
  void ShowWhole();
  /** Restores saved work on a scene that has been opened; where it does not fit, the scene as
   opened. */
  [[nodiscard]] SceneSnapshot RestoreWork(const SavedWork& kept,
                                          const std::shared_ptr<const OpenScene>& opened);

  const Parts parts_;

  mutable std::mutex mutex_;  ///< Protects what follows.
  std::stop_source opening_;
  std::filesystem::path requested_;  ///< File that was asked for last.
  /** Scene that takes the place of the one of its first parts; null: none. */
  std::shared_ptr<const OpenScene> whole_;
  Json failure_;  ///< Event of the last file that could not be opened; null: none.
  Json resumed_;  ///< Event "resumed", until the next change; null: none.
};

}  // namespace hvas::studio
