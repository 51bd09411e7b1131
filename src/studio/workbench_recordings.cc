#include "studio/workbench_recordings.h"

#include <utility>

#include "studio/event_json.h"
#include "studio/scene_json.h"

namespace hvas::studio {

WorkbenchRecordings::WorkbenchRecordings(const std::filesystem::path& folder, LiveScene* live,
                                         EventBus* events, JobThread* worker)
    : live_(live), events_(events), worker_(worker), shelf_(folder) {
  events->Subscribe([this](const Json& event) {
    if (const auto now = recording()) {
      now->AddClientEvent(event);
    }
  });
}

Result<void> WorkbenchRecordings::Start(const std::string& name) {
  if (auto idle = live_->CheckIdle(); !idle) {
    return idle;
  }
  if (recording() != nullptr) {
    return Fail(ErrorCode::kInvalid, "a recording is in progress", "", "stop the recording first");
  }
  const auto file = shelf_.MakePath(live_->scene()->model->product->name);
  if (!file) {
    return Unexpected(file.error());
  }
  worker_->Post(
      [this, file = *file, name](const std::stop_token& /*stop*/) { DoStart(file, name); });
  return {};
}

void WorkbenchRecordings::DoStart(const std::filesystem::path& file, const std::string& name) {
  const auto [scene, state] = live_->MakeSnapshot();
  if (recording() != nullptr) {
    return;  // another client was faster
  }
  const std::string called = name.empty() ? shelf_.MakeName(scene->model->product->name) : name;
  const auto on_failed = [this] {
    worker_->Post([this](const std::stop_token& /*stop*/) { FinishFailed(); });
  };
  auto started = Recording::Start(file, called, scene, MakeSceneJson(*scene, state), on_failed);
  if (!started) {
    events_->Publish(
        {{"event", "failed"}, {"file", "recording"}, {"error", ToJson(started.error())}});
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    recording_ = *started;
  }
  live_->Restart(false);  // a record begins with the setup of the hands and all poses
  PublishRecording((*started)->Describe());
}

Result<void> WorkbenchRecordings::Stop() {
  if (recording() == nullptr) {
    return Fail(ErrorCode::kInvalid, "no recording is in progress", "", "");
  }
  worker_->Post([this](const std::stop_token& /*stop*/) { Finish(); });
  return {};
}

void WorkbenchRecordings::Finish() {
  std::shared_ptr<Recording> ended;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(recording_, nullptr);
  }
  if (ended == nullptr) {
    return;
  }
  if (const auto stopped = ended->Stop(); !stopped) {
    events_->Publish(
        {{"event", "failed"}, {"file", "recording"}, {"error", ToJson(stopped.error())}});
  }
  PublishRecording(ended->Describe());
}

void WorkbenchRecordings::FinishFailed() {
  if (const auto now = recording(); now != nullptr && now->has_failed()) {
    Finish();
  }
}

void WorkbenchRecordings::ConfigureRun(const OpenScene& scene, LiveOptions* live) {
  if (const auto now = recording(); now != nullptr && now->scene() != &scene) {
    Finish();  // a record has one scene
  }
  live->recording = recording();
}

void WorkbenchRecordings::PublishRecording(Json recording) const {
  recording["event"] = "recording";
  events_->Publish(recording);
  events_->Publish({{"event", "recordings"}});
}

std::shared_ptr<Recording> WorkbenchRecordings::recording() const {
  const std::lock_guard lock(mutex_);
  return recording_;
}

Json WorkbenchRecordings::Describe() const {
  const auto now = recording();
  return now != nullptr ? now->Describe() : Json(nullptr);
}

Result<void> WorkbenchRecordings::Rename(const std::string& id, const std::string& name) {
  auto renamed = shelf_.Rename(id, name);
  if (renamed) {
    events_->Publish({{"event", "recordings"}});
  }
  return renamed;
}

Result<void> WorkbenchRecordings::Share(const std::string& id, bool is_shared) {
  const auto found = live_->FindScene();
  if (!found) {
    return Unexpected(found.error());
  }
  const OpenScene& scene = **found;
  auto shared = shelf_.Share(id, *scene.model->product, scene.digest, is_shared);
  if (shared) {
    events_->Publish({{"event", "recordings"}});
  }
  return shared;
}

std::string WorkbenchRecordings::FindDigest() const {
  const auto scene = live_->scene();
  return scene != nullptr ? scene->digest : std::string();
}

Result<void> WorkbenchRecordings::Delete(const std::string& id) {
  if (const Json now = Describe(); !now.is_null() && now["id"] == id) {
    return Fail(ErrorCode::kInvalid, "this recording is in progress", id,
                "stop the recording first");
  }
  auto deleted = shelf_.Delete(id);
  if (deleted) {
    events_->Publish({{"event", "recordings"}});
  }
  return deleted;
}

}  // namespace hvas::studio
