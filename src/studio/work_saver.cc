#include "studio/work_saver.h"

#include <utility>

#include "studio/event_json.h"
#include "studio/saved_work.h"

namespace hvas::studio {

WorkSaver::WorkSaver(std::filesystem::path file, const LiveScene* live,
                     const WorkbenchTrials* trials, const EventBus* events)
    : file_(std::move(file)), live_(live), trials_(trials), events_(events) {}

void WorkSaver::BackUp() const {
  BackUpWork(file_);
}

void WorkSaver::Stop() {
  if (!std::exchange(has_stopped_, true)) {
    thread_.Stop();
    Save();
  }
}

void WorkSaver::OnStep(const OpenScene& /*scene*/, std::size_t /*step*/, bool /*has_person*/) {
  ScheduleSave();
}

void WorkSaver::ScheduleSave() {
  if (!file_.empty()) {
    (void)thread_.TryPost([this](const std::stop_token& /*stop*/) { Save(); }, 1);
  }
}

void WorkSaver::Save() {
  const SceneSnapshot now = live_->MakeRestingSnapshot();
  if (file_.empty() || now.scene == nullptr || trials_->trial() != nullptr ||
      simulation::CountPending(*now.scene->model) > 0) {
    return;
  }
  const auto saved = SaveWork(file_, MakeSavedWork(now));
  if (!saved && std::exchange(can_save_, false)) {
    events_->Publish(
        {{"event", "failed"}, {"file", now.scene->name}, {"error", ToJson(saved.error())}});
  }
  can_save_ = saved.has_value();
}

}  // namespace hvas::studio
