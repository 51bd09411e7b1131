#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "studio/live_run.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** What is open, and how far it has come. */
struct SceneNow {
  std::shared_ptr<const OpenScene> scene;  ///< Null while nothing is.
  LiveState state;
};

/** What was done and can be undone, and what was undone and can be done again. Any thread. */
class History {
 public:
  enum class Direction { kUndo, kRedo };

  /** Of what is forgotten first. */
  static constexpr std::size_t kMostMoments = 100;

  /** @param before  How all was before it.
      @param what  Was done, as people call it. */
  void Remember(SceneNow before, const std::string& what);

  /** Errors (kNotFound): there is nothing to go to. */
  [[nodiscard]] Result<void> Check(Direction direction) const;

  /** One step; nothing where there is none.
   @param now  To come back to. @returns how all was then. */
  [[nodiscard]] std::optional<SceneNow> Go(Direction direction, const SceneNow& now);

  void Clear();

  /** The event "history" of docs/protocol.md. */
  [[nodiscard]] nlohmann::ordered_json Describe() const;

 private:
  struct Moment {
    SceneNow scene;
    std::string what;  ///< Was done after it.
  };

  mutable std::mutex mutex_;
  std::vector<Moment> undo_;
  std::vector<Moment> redo_;
};

}  // namespace hvas::studio
