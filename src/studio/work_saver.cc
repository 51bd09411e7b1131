#include "studio/work_saver.h"

#include <utility>

#include "studio/event_json.h"
#include "studio/saved_work.h"

namespace hvas::studio {

WorkSaver::WorkSaver(std::filesystem::path file, const Sources& sources, const EventBus* events)
    : file_(std::move(file)), sources_(sources), events_(events) {}

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
  const SceneSnapshot now = sources_.live->MakeRestingSnapshot();
  if (file_.empty() || now.scene == nullptr || sources_.trials->trial() != nullptr ||
      simulation::CountPending(*now.scene->model) > 0) {
    return;
  }
  SavedWork work = MakeSavedWork(now);
  work.notes = sources_.notes->List();
  const auto saved = SaveWork(file_, work);
  if (!saved && std::exchange(can_save_, false)) {
    events_->Publish(
        {{"event", "failed"}, {"file", now.scene->name}, {"error", ToJson(saved.error())}});
  }
  can_save_ = saved.has_value();
}

}  // namespace hvas::studio
