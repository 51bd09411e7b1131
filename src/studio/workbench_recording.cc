// Recordings of the work on the workbench.

#include <utility>

#include "studio/event_json.h"
#include "studio/scene_json.h"
#include "studio/workbench.h"

namespace hvas::studio {

Result<void> Workbench::StartRecording(const std::string& name) {
  if (auto idle = CheckIdle(); !idle) {
    return idle;
  }
  {
    const std::lock_guard lock(mutex_);
    if (recording_ != nullptr) {
      return Fail(ErrorCode::kInvalid, "a recording is in progress", "",
                  "stop the recording first");
    }
  }
  const auto file = shelf_.MakePath(scene()->model->product->name);
  if (!file) {
    return Unexpected(file.error());
  }
  Post([this, file = *file, name] { DoStartRecording(file, name); });
  return {};
}

void Workbench::DoStartRecording(const std::filesystem::path& file, const std::string& name) {
  const auto [scene, state] = MakeSnapshot();
  if (!recording().is_null()) {
    return;  // another client was faster
  }
  const std::string called = name.empty() ? shelf_.MakeName(scene->model->product->name) : name;
  auto started = Recording::Start(file, called, scene, MakeSceneJson(*scene, state),
                                  [this] { Post([this] { EndFailedRecording(); }); });
  if (!started) {
    Publish({{"event", "failed"}, {"file", file.string()}, {"error", ToJson(started.error())}});
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    recording_ = *started;
  }
  Restart(false);  // a record begins with the setup of the hands and all poses
  PublishRecording((*started)->Describe());
}

Result<void> Workbench::StopRecording() {
  {
    const std::lock_guard lock(mutex_);
    if (recording_ == nullptr) {
      return Fail(ErrorCode::kInvalid, "no recording is in progress", "", "");
    }
  }
  Post([this] { FinishRecording(); });
  return {};
}

void Workbench::FinishRecording() {
  std::shared_ptr<Recording> ended;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(recording_, nullptr);
  }
  if (ended == nullptr) {
    return;
  }
  if (const auto stopped = ended->Stop(); !stopped) {
    Publish({{"event", "failed"}, {"file", "recording"}, {"error", ToJson(stopped.error())}});
  }
  PublishRecording(ended->Describe());
}

void Workbench::EndFailedRecording() {
  std::shared_ptr<Recording> recording;
  {
    const std::lock_guard lock(mutex_);
    recording = recording_;
  }
  if (recording != nullptr && recording->has_failed()) {
    FinishRecording();
  }
}

void Workbench::PublishRecording(Json recording) const {
  recording["event"] = "recording";
  Publish(std::move(recording));
  Publish({{"event", "recordings"}});
}

Json Workbench::recording() const {
  const std::lock_guard lock(mutex_);
  return recording_ != nullptr ? recording_->Describe() : Json(nullptr);
}

Result<void> Workbench::RenameRecording(const std::string& id, const std::string& name) {
  auto renamed = shelf_.Rename(id, name);
  if (renamed) {
    Publish({{"event", "recordings"}});
  }
  return renamed;
}

Result<void> Workbench::DeleteRecording(const std::string& id) {
  if (const Json now = recording(); !now.is_null() && now["id"] == id) {
    return Fail(ErrorCode::kInvalid, "this recording is in progress", id,
                "stop the recording first");
  }
  auto deleted = shelf_.Delete(id);
  if (deleted) {
    Publish({{"event", "recordings"}});
  }
  return deleted;
}

}  // namespace hvas::studio
