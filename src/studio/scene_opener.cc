#include "studio/scene_opener.h"

#include <algorithm>
#include <utility>

#include "studio/event_json.h"

namespace hvas::studio {
namespace {

using simulation::Placement;

/** @param begun  Snapshot after resuming; without parts where the saved state was not restored. */
Json MakeResumedEvent(const SceneSnapshot& begun) {
  const auto& parts = begun.state.parts;
  return {{"event", "resumed"},
          {"is_resumed", !parts.empty()},
          {"seated",
           std::count_if(parts.begin(), parts.end(),
                         [](const auto& part) { return part.placement == Placement::kPlaced; })},
          {"edits", begun.scene->edits.size()}};
}

/** Whether no part is in its place but those that others are put onto. */
bool AreOnlyBasesPlaced(const LiveState& state, const simulation::Model& model) {
  return std::none_of(model.bodies.begin(), model.bodies.end(), [&](const simulation::Body& body) {
    return body.role == simulation::BodyRole::kPart &&
           state.parts[body.occurrence.index()].placement == Placement::kPlaced &&
           !IsBase(model.sequence, body.occurrence);
  });
}

/** The state of parts with the model in which all are ready: those that have not been touched lie
 where it has them, and so does the base as long as nothing was put onto it: it may be another one.
 */
LiveState CarryOver(LiveState state, const simulation::Model& before,
                    const simulation::Model& after) {
  const bool is_untouched = AreOnlyBasesPlaced(state, before);
  for (std::size_t i = 0; i < state.parts.size(); ++i) {
    simulation::PartState& part = state.parts[i];
    const simulation::Body& body = after.bodies[i];
    const bool is_where_it_was =
        part.X_WB.p() == before.bodies[i].X_WB_start.p() && !part.leader.is_valid();
    const bool is_table_elsewhere = before.table_z != after.table_z;
    const bool was_base = is_untouched && part.placement == Placement::kPlaced;
    if (part.placement == Placement::kPending || was_base ||
        (part.placement == Placement::kLoose && (is_where_it_was || is_table_elsewhere))) {
      part = {simulation::BeginningOf(body.role), body.X_WB_start};
    }
  }
  state.next_step = 0;
  return state;
}

}  // namespace

void SceneOpener::Open(const std::filesystem::path& file, const std::string& name, When when) {
  Post(file, [this, file, name, when] { DoOpen(file, name, when, nullptr); });
}

void SceneOpener::Resume(const SavedWork& work) {
  Post(work.file, [this, work] { DoOpen(work.file, work.name, When::kWhole, &work); });
}

void SceneOpener::Post(const std::filesystem::path& file, std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    opening_.request_stop();  // a newer request replaces the one in progress
    opening_ = {};
    requested_ = file;
  }
  parts_.worker->Post([job = std::move(job)](const std::stop_token& /*stop*/) { job(); });
}

bool SceneOpener::IsInUse(const std::filesystem::path& file) const {
  const auto scene = parts_.live->scene();
  const std::lock_guard lock(mutex_);
  return file == requested_ || (scene != nullptr && file == scene->file);
}

void SceneOpener::Cancel() {
  const std::lock_guard lock(mutex_);
  opening_.request_stop();
}

void SceneOpener::DoOpen(const std::filesystem::path& file, const std::string& name, When when,
                         const SavedWork* kept) {
  std::stop_token stop;
  {
    const std::lock_guard lock(mutex_);
    stop = opening_.get_token();
    whole_ = nullptr;
  }
  const SceneSnapshot before = parts_.live->MakeRestingSnapshot();
  SceneBuilder::SceneFn on_first_parts;
  if (when == When::kFirstParts) {
    on_first_parts = [this](const auto& first) { Show({first, {}}); };
  }
  const auto scene = parts_.builder->Open(file, name, MakeProgressListener(parts_.events, name),
                                          stop, on_first_parts);
  const auto shown = parts_.live->scene();
  const bool has_begun = shown != before.scene;
  if (!scene) {
    if (has_begun && before.scene != nullptr) {
      parts_.live->Show(before.scene, before.state, false, name + " was not opened");
    }
    const Json failed{{"event", "failed"}, {"file", name}, {"error", ToJson(scene.error())}};
    {
      const std::lock_guard lock(mutex_);
      failure_ = failed;
    }
    parts_.events->Publish(failed);
    return;
  }
  if (has_begun) {
    {
      const std::lock_guard lock(mutex_);
      whole_ = *scene;
      failure_ = nullptr;
      resumed_ = nullptr;
    }
    ShowWhole();
    return;
  }
  const SceneSnapshot begun =
      kept != nullptr ? RestoreWork(*kept, *scene) : SceneSnapshot{*scene, {}};
  const Json resumed = kept != nullptr ? MakeResumedEvent(begun) : Json(nullptr);
  {
    const std::lock_guard lock(mutex_);
    failure_ = nullptr;
    resumed_ = resumed;
  }
  if (kept != nullptr && begun.state.parts.empty()) {
    parts_.saver->BackUp();
  }
  Show(begun);
  if (kept != nullptr && !begun.state.parts.empty()) {
    parts_.notes->Restore(kept->notes);
  }
  if (!resumed.is_null()) {
    parts_.events->Publish(resumed);
  }
}

void SceneOpener::Show(const SceneSnapshot& snapshot, const std::string& why) {
  parts_.edits->ClearHistory();
  parts_.live->Show(snapshot.scene, snapshot.state, false, why);
  if (why.empty()) {
    parts_.paths->Clear();  // paths of the previous product, whose last frame has come
  }
  parts_.edits->PublishHistory();
}

void SceneOpener::ShowWhole() {
  if (parts_.live->is_holding()) {
    return;
  }
  std::shared_ptr<const OpenScene> whole;
  {
    const std::lock_guard lock(mutex_);
    whole = std::exchange(whole_, nullptr);
  }
  if (whole == nullptr) {
    return;
  }
  const SceneSnapshot before = parts_.live->MakeRestingSnapshot();
  Show({whole, CarryOver(before.state, *before.scene->model, *whole->model)},
       "all parts are ready");
}

SceneSnapshot SceneOpener::RestoreWork(const SavedWork& kept,
                                       const std::shared_ptr<const OpenScene>& opened) {
  if (opened->digest != kept.digest || opened->model->bodies.size() != kept.state.parts.size()) {
    return {opened, {}};
  }
  SceneSnapshot begun{opened, kept.state};
  if (!kept.edits.empty()) {
    auto edited = parts_.builder->ApplyEdits(*opened, kept.edits,
                                             MakeProgressListener(parts_.events, kept.name));
    if (!edited) {
      return {opened, {}};
    }
    begun.scene = std::move(*edited);
  }
  const std::size_t steps = begun.scene->model->sequence.steps.size();
  begun.state.next_step = std::min(begun.state.next_step, steps);
  return begun;
}

void SceneOpener::OnHold(const simulation::SimulationEvent& /*event*/,
                         const std::optional<SceneSnapshot>& /*before*/) {
  const std::lock_guard lock(mutex_);
  resumed_ = nullptr;
}

void SceneOpener::OnPlacement() {
  const std::lock_guard lock(mutex_);
  if (whole_ != nullptr) {
    parts_.worker->Post([this](const std::stop_token& /*stop*/) { ShowWhole(); });
  }
}

std::vector<Json> SceneOpener::MakeCatchUpEvents() const {
  const bool is_open = parts_.live->scene() != nullptr;
  std::vector<Json> news;
  const std::lock_guard lock(mutex_);
  if (!is_open && !failure_.is_null()) {
    news.push_back(failure_);
  }
  if (!resumed_.is_null()) {
    news.push_back(resumed_);
  }
  return news;
}

}  // namespace hvas::studio
