#include "studio/workbench_edits.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "studio/event_json.h"

namespace hvas::studio {
namespace {

using sequence::SequenceStep;
using simulation::Placement;

bool HasSameOrder(const sequence::Sequence& a, const sequence::Sequence& b) {
  return std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(),
                    [](const SequenceStep& x, const SequenceStep& y) {
                      return x.kind == y.kind && x.occurrence == y.occurrence;
                    });
}

/** Description of a release for the undo list; null where nothing has changed. */
const char* DescribeRelease(const SceneSnapshot& before,
                            const simulation::SimulationEvent& dropped) {
  const bool was_placed =
      before.state.parts[dropped.occurrence.index()].placement == Placement::kPlaced;
  if (dropped.was_seated) {
    return was_placed ? nullptr : "insert";
  }
  return was_placed ? "take out" : "move";
}

bool IsSamePlace(const spatial::Pose& x, const spatial::Pose& y) {
  return x.p() == y.p() && x.q().coeffs() == y.q().coeffs();
}

/** The state of the parts with a model in which mates of the user put some of them elsewhere: these
 go back onto the table, and so do loose ones, as the table may be elsewhere. */
LiveState FollowPlaces(LiveState state, const simulation::Model& before,
                       const simulation::Model& after) {
  const auto is_moved = [&](std::size_t i) {
    return !IsSamePlace(before.bodies[i].X_WB_goal, after.bodies[i].X_WB_goal);
  };
  bool is_any_moved = false;
  for (std::size_t i = 0; i < state.parts.size(); ++i) {
    is_any_moved = is_any_moved || is_moved(i);
  }
  for (std::size_t i = 0; is_any_moved && i < state.parts.size(); ++i) {
    if (is_moved(i) || state.parts[i].placement != Placement::kPlaced) {
      state.parts[i] = {Placement::kLoose, after.bodies[i].X_WB_start};
    }
  }
  state.next_step =
      !is_any_moved && HasSameOrder(before.sequence, after.sequence) ? state.next_step : 0;
  return state;
}

}  // namespace

Result<void> WorkbenchEdits::Change(const Edit& edit) {
  if (auto idle = live_->CheckIdle(); !idle) {
    return idle;
  }
  // The edit is tried here first, so that its errors are in the reply.
  product::Product trial = *live_->scene()->model->product;
  auto changed = edit.change(&trial);
  if (changed) {
    worker_->Post([this, edit](const std::stop_token& /*stop*/) { DoChange(edit); });
  }
  return changed;
}

void WorkbenchEdits::DoChange(const Edit& edit) {
  const auto after =
      builder_->Change(*live_->scene(), edit, MakeProgressListener(events_, edit.what));
  if (!after) {
    events_->Publish({{"event", "failed"}, {"file", edit.what}, {"error", ToJson(after.error())}});
    return;
  }
  Replace(*after, edit.what);
}

void WorkbenchEdits::Replace(const std::shared_ptr<const OpenScene>& after,
                             const std::string& what) {
  const SceneSnapshot before = live_->MakeRestingSnapshot();
  Remember(before, what);
  // In the new order, parts that are in their place already are skipped.
  live_->Show(after, FollowPlaces(before.state, *before.scene->model, *after->model), false, what);
}

Result<void> WorkbenchEdits::GoTo(History::Direction direction) {
  auto possible = live_->CheckIdle();
  if (possible) {
    possible = history_.Check(direction);
  }
  if (possible) {
    worker_->Post([this, is_undo = direction == History::Direction::kUndo,
                   direction](const std::stop_token& /*stop*/) {
      if (const auto then = history_.Go(
              direction, live_->MakeSnapshot())) {  // empty when another client was faster
        live_->Show(then->scene, then->state, false, is_undo ? "undone" : "done again");
        PublishHistory();
      }
    });
  }
  return possible;
}

Result<void> WorkbenchEdits::Reset() {
  auto idle = live_->CheckIdle();
  if (idle) {
    worker_->Post([this](const std::stop_token& /*stop*/) {
      Remember(live_->MakeSnapshot(), "reset");
      live_->Show(live_->scene(), {}, false);
    });
  }
  return idle;
}

void WorkbenchEdits::Remember(SceneSnapshot before, const std::string& what) {
  history_.Remember(std::move(before), what);
  PublishHistory();
}

void WorkbenchEdits::OnHold(const simulation::SimulationEvent& event,
                            const std::optional<SceneSnapshot>& before) {
  const bool is_dropped = event.kind == simulation::SimulationEvent::Kind::kDropped;
  const char* what = is_dropped && before ? DescribeRelease(*before, event) : nullptr;
  if (what != nullptr) {
    const product::Product& product = *before->scene->model->product;
    Remember(*before,
             fmt::format("{} {}", what, product.occurrences[event.occurrence.index()].name));
  }
}

}  // namespace hvas::studio
