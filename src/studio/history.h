#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "studio/json.h"
#include "studio/live_run.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** Snapshot of a scene and its state of assembly. */
struct SceneSnapshot {
  std::shared_ptr<const OpenScene> scene;  ///< Null while no file is open.
  LiveState state;
};

/** Undo and redo lists. Any thread may call it. */
class History {
 public:
  enum class Direction { kUndo, kRedo };

  /** Capacity of each list; beyond it the oldest moment is dropped. */
  static constexpr std::size_t kMaxMoments = 100;

  /** Adds an undo step. @param before  Snapshot before the action.
   @param what  Description of the action for people. */
  void Remember(SceneSnapshot before, const std::string& what);

  /** Errors: kNotFound when the list of this direction is empty. */
  [[nodiscard]] Result<void> Check(Direction direction) const;

  /** Goes one step in a direction. @param now  Present snapshot, for the opposite list.
   @returns the snapshot to restore; none where the list is empty. */
  [[nodiscard]] std::optional<SceneSnapshot> Go(Direction direction, const SceneSnapshot& now);

  void Clear();

  /** Makes the event "history" of docs/protocol.md. */
  [[nodiscard]] Json Describe() const;

 private:
  struct Moment {
    SceneSnapshot scene;
    std::string what;  ///< Description of the action that followed it.
  };

  mutable std::mutex mutex_;
  std::vector<Moment> undo_;
  std::vector<Moment> redo_;
  std::size_t forgotten_{0};  ///< Undo steps that were dropped since the list was cleared.
};

}  // namespace hvas::studio
