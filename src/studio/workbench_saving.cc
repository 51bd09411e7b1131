// Saving of the work for the next start of the studio, and resuming it.

#include <algorithm>
#include <utility>

#include "studio/event_json.h"
#include "studio/workbench.h"

namespace hvas::studio {

using simulation::Placement;

void Workbench::Resume(const SavedWork& work) {
  PostOpen([this, work] { DoOpen(work.file, work.name, &work); });
}

SceneSnapshot Workbench::RestoreWork(const SavedWork& kept,
                                     const std::shared_ptr<const OpenScene>& opened) {
  if (opened->digest != kept.digest || opened->model->bodies.size() != kept.state.parts.size()) {
    return {opened, {}};
  }
  SceneSnapshot begun{opened, kept.state};
  if (!kept.edits.empty()) {
    auto edited = builder_.ApplyEdits(*opened, kept.edits, MakeProgressListener(kept.name));
    if (!edited) {
      return {opened, {}};
    }
    begun.scene = std::move(*edited);
  }
  const std::size_t steps = begun.scene->model->sequence.steps.size();
  begun.state.next_step = std::min(begun.state.next_step, steps);
  return begun;
}

void Workbench::ScheduleSave() {
  if (!options_.work_file.empty()) {
    (void)keeper_.TryPost([this](const std::stop_token&) { DoSaveWork(); }, 1);
  }
}

void Workbench::DoSaveWork() {
  const SceneSnapshot now = MakeRestingSnapshot();
  if (options_.work_file.empty() || now.scene == nullptr || trial() != nullptr) {
    return;
  }
  const auto saved = SaveWork(options_.work_file, MakeSavedWork(now));
  if (!saved && std::exchange(can_save_work_, false)) {
    Publish({{"event", "failed"}, {"file", now.scene->name}, {"error", ToJson(saved.error())}});
  }
  can_save_work_ = saved.has_value();
}

SceneSnapshot Workbench::MakeRestingSnapshot() const {
  const std::lock_guard lock(mutex_);
  SceneSnapshot now{scene_, run_ != nullptr ? run_->state() : resting_};
  for (std::size_t i = 0; i < now.state.parts.size(); ++i) {
    simulation::PartState& part = now.state.parts[i];
    if (part.placement != Placement::kHeld) {
      continue;
    }
    part = {Placement::kLoose, scene_->model->bodies[i].X_WB_start};
    for (const auto& before : before_take_) {
      if (before && before->scene == scene_ &&
          before->state.parts[i].placement != Placement::kHeld) {
        part = before->state.parts[i];
      }
    }
  }
  return now;
}

}  // namespace hvas::studio
