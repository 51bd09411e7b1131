#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/job_thread.h"
#include "base/result.h"
#include "studio/edit.h"
#include "studio/event_bus.h"
#include "studio/history.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/scene_builder.h"
#include "studio/scene_observer.h"

namespace hvas::studio {

/** Changes of the open product and of its state of assembly, with undo and redo. Any thread may
 call any function; all return at once, and leave slow work to the worker. */
class WorkbenchEdits final : public SceneObserver {
 public:
  /** @param builder  Used by the worker alone. */
  WorkbenchEdits(SceneBuilder* builder, LiveScene* live, EventBus* events, JobThread* worker)
      : builder_(builder), live_(live), events_(events), worker_(worker) {}

  /** Applies an edit: compiles a model of the changed product in the background and swaps it in. */
  [[nodiscard]] Result<void> Change(const Edit& edit);

  [[nodiscard]] Result<void> Undo() { return GoTo(History::Direction::kUndo); }

  [[nodiscard]] Result<void> Redo() { return GoTo(History::Direction::kRedo); }

  /** Puts all parts back on the table. */
  [[nodiscard]] Result<void> Reset();

  /** Shows another scene of the same parts, whose parts stay where they are unless mates of the
   user put them elsewhere; it can be undone. For the worker thread. @param what  As of Remember().
 */
  void Replace(const std::shared_ptr<const OpenScene>& after, const std::string& what);

  /** Adds an undo step and publishes the history. @param before  Snapshot before the action.
   @param what  Description of the action for people. */
  void Remember(SceneSnapshot before, const std::string& what);

  /** Clears the lists of undo and redo, and publishes nothing. */
  void ClearHistory() { history_.Clear(); }

  void PublishHistory() const { events_->Publish(DescribeHistory()); }

  /** Makes the event "history" of docs/protocol.md. */
  [[nodiscard]] Json DescribeHistory() const { return history_.Describe(); }

 private:
  [[nodiscard]] Result<void> GoTo(History::Direction direction);
  void DoChange(const Edit& edit);
  void OnHold(const simulation::SimulationEvent& event,
              const std::optional<SceneSnapshot>& before) override;

  SceneBuilder* const builder_;
  LiveScene* const live_;
  EventBus* const events_;
  JobThread* const worker_;
  History history_;
};

}  // namespace hvas::studio
