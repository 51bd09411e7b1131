#include "studio/workbench.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "studio/event_json.h"
#include "studio/next_step.h"
#include "studio/scene_json.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using simulation::Placement;
using simulation::SequenceStep;

Json MakeStepEvent(const OpenScene& scene, std::size_t step) {
  return {{"event", "step"}, {"index", step}, {"total", scene.model->sequence.steps.size()}};
}

bool HasSameOrder(const simulation::Sequence& a, const simulation::Sequence& b) {
  return std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(),
                    [](const SequenceStep& x, const SequenceStep& y) {
                      return x.kind == y.kind && x.occurrence == y.occurrence;
                    });
}

/** Makes the initial state: all parts lie on the table. */
LiveState MakeStart(const simulation::Model& model) {
  LiveState state;
  for (const simulation::Body& body : model.bodies) {
    state.parts.push_back({Placement::kLoose, body.X_WB_start});
  }
  return state;
}

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

std::array<double, 2> CalcHandSpeeds(const simulation::Frame& before,
                                     const simulation::Frame& after) {
  std::array<double, 2> speeds{};
  const double elapsed = 1e-9 * static_cast<double>(after.t_ns - before.t_ns);
  for (std::size_t i = 0; i < after.ticks.size(); ++i) {
    if (i < before.ticks.size() && elapsed > 0) {
      speeds[i] = (after.ticks[i].X_WH.p() - before.ticks[i].X_WH.p()).norm() / elapsed;
    }
  }
  return speeds;
}

}  // namespace

Workbench::Workbench(WorkbenchOptions options)
    : options_(std::move(options)), builder_(options_.scenes), shelf_(options_.recordings_folder) {}

Workbench::~Workbench() {
  Stop();
}

void Workbench::Stop() {
  worker_.RequestStop();
  Cancel();           // after the flag is set, so that nothing else begins
  FinishRecording();  // before anything that takes long
  EndRun();
  sweeper_.Stop();
  worker_.Stop();
  EndRun();  // a run that the worker has just begun
  FinishRecording();
  if (!std::exchange(has_stopped_, true)) {
    keeper_.Stop();
    DoSaveWork();
  }
}

void Workbench::EndRun() {
  std::shared_ptr<LiveRun> ended;
  {
    const std::lock_guard lock(mutex_);
    if (run_ != nullptr) {
      resting_ = run_->state();
    }
    ended = std::exchange(run_, nullptr);
  }
  ended.reset();  // its threads end here, outside the lock that they may wait for
}

void Workbench::Post(std::function<void()> job) {
  worker_.Post([job = std::move(job)](const std::stop_token&) { job(); });
}

void Workbench::Publish(Json event) const {
  std::shared_ptr<Recording> recording;
  {
    const std::lock_guard lock(mutex_);
    recording = recording_;
  }
  if (recording != nullptr) {
    recording->AddClientEvent(event);
  }
  if (on_event) {
    on_event(std::move(event));
  }
}

void Workbench::Open(const std::filesystem::path& file, const std::string& name) {
  PostOpen([this, file, name] { DoOpen(file, name, nullptr); });
}

void Workbench::PostOpen(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    opening_.request_stop();  // a newer request replaces the one in progress
    opening_ = {};
  }
  Post(std::move(job));
}

void Workbench::Cancel() {
  const std::lock_guard lock(mutex_);
  opening_.request_stop();
}

void Workbench::DoOpen(const std::filesystem::path& file, const std::string& name,
                       const SavedWork* kept) {
  std::stop_token stop;
  {
    const std::lock_guard lock(mutex_);
    stop = opening_.get_token();
  }
  const auto scene = builder_.Open(file, name, MakeProgressListener(name), stop);
  if (!scene) {
    Json failed{{"event", "failed"}, {"file", name}, {"error", ToJson(scene.error())}};
    {
      const std::lock_guard lock(mutex_);
      failure_ = failed;
    }
    Publish(std::move(failed));
    return;
  }
  history_.Clear();
  const SceneSnapshot begun =
      kept != nullptr ? RestoreWork(*kept, *scene) : SceneSnapshot{*scene, {}};
  {
    const std::lock_guard lock(mutex_);
    failure_ = nullptr;
    resumed_ = kept != nullptr ? MakeResumedEvent(begun) : Json(nullptr);
  }
  if (kept != nullptr && begun.state.parts.empty()) {
    BackUpWork(options_.work_file);
  }
  Show(begun.scene, begun.state, false);
  paths_.Clear();  // paths of the previous product, whose last frame has come
  PublishHistory();
  if (kept != nullptr) {
    Publish(MakeResumedEvent(begun));
  }
}

cad::ProgressFn Workbench::MakeProgressListener(const std::string& name) const {
  return [this, name](std::string_view stage, double fraction) {
    Publish({{"event", "progress"}, {"stage", stage}, {"fraction", fraction}, {"file", name}});
  };
}

void Workbench::Show(const std::shared_ptr<const OpenScene>& scene, const LiveState& state,
                     bool has_person, const std::string& why) {
  LiveOptions live;
  live.has_person = has_person;
  live.hands = rack_.setups();
  live.seed = options_.scenes.seed;
  live.rate_hz = options_.rate_hz;
  live.trial = trial();
  std::shared_ptr<LiveRun> ended;
  bool is_new = false;
  bool is_recorded = false;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(run_, nullptr);
    is_new = scene_ != scene;
    scene_ = scene;
    resting_ = state.parts.empty() ? MakeStart(*scene->model) : state;
    before_take_ = {};
    is_recorded = recording_ != nullptr && recording_->scene() == scene.get();
  }
  ended.reset();  // its threads end here, outside the lock that they may wait for
  if (!is_recorded) {
    FinishRecording();  // a record has one scene
  }
  is_demo_ = has_person;  // after the last events of the previous run
  {
    const std::lock_guard lock(mutex_);
    live.recording = recording_;
  }
  auto run = std::make_shared<LiveRun>(scene->model, state, live, MakeListeners(scene, live));
  run->StopForces(forces_off_);
  {
    const std::lock_guard lock(mutex_);
    run_ = run;
  }
  if (is_new) {
    Publish({{"event", "scene"},
             {"epoch", scene->epoch},
             {"why", why.empty() ? Json(nullptr) : Json(why)}});
  } else {
    PublishPlacements();
  }
  PublishStep(*scene, run->state().next_step);
  PublishHands();
  ScheduleSave();
}

void Workbench::Restart(bool has_person) {
  std::shared_ptr<const OpenScene> scene;
  std::shared_ptr<LiveRun> run;
  {
    const std::lock_guard lock(mutex_);
    scene = scene_;
    run = run_;
  }
  if (run == nullptr) {
    return;
  }
  const LiveState state = run->state();
  run.reset();
  Show(scene, state, has_person);
  Publish({{"event", "demo"}, {"on", has_person}});
}

LiveListeners Workbench::MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                       const LiveOptions& live) {
  LiveListeners listeners;
  listeners.on_event = [this, scene](const simulation::SimulationEvent& event) {
    HandleEvent(*scene, event);
  };
  listeners.on_placement = [this](OccurrenceId id, Placement placement) {
    Publish(
        {{"event", "placement"}, {"occurrence", id.value()}, {"placement", ToString(placement)}});
    ScheduleSave();
  };
  listeners.on_step = [this, scene, has_person = live.has_person](std::size_t step) {
    HandleStep(*scene, step, has_person);
  };
  listeners.on_frame = [this, epoch = scene->epoch, recording = live.recording](
                           const simulation::Frame& frame, std::int64_t clock_ns,
                           const PeakForces& peak_felt) {
    LiveFrame shown;
    {
      const std::lock_guard lock(mutex_);
      const auto speed = CalcHandSpeeds(frame_.frame, frame);
      frame_ = {epoch, frame_.serial + 1, frame, clock_ns, peak_felt, speed};
      shown = recording != nullptr ? frame_ : LiveFrame();
    }
    if (recording != nullptr) {
      recording->AddFrame(shown);
    }
    paths_.Add(frame);
    if (on_frame) {
      on_frame();
    }
  };
  return listeners;
}

void Workbench::HandleEvent(const OpenScene& scene, const simulation::SimulationEvent& event) {
  HandleHold(scene, event);
  HandleDevice(event);
  if (Json json = ToJson(event); !json.is_null()) {
    Publish(std::move(json));
  }
}

void Workbench::PublishStep(const OpenScene& scene, std::size_t step) const {
  Publish(MakeStepEvent(scene, step));
}

void Workbench::HandleStep(const OpenScene& scene, std::size_t step, bool has_person) {
  PublishStep(scene, step);
  ScheduleSave();
  const auto& steps = scene.model->sequence.steps;
  const bool is_finished = step >= steps.size();
  // Placing a fixture part is no work of a person, and does not end a demo of one step.
  const bool is_work = step > 0 && steps[step - 1].kind != SequenceStep::Kind::kBase;
  if (has_person && (is_finished || (is_work && ends_demo_after_step_.exchange(false)))) {
    Post([this] { Restart(false); });
  }
}

void Workbench::Remember(SceneSnapshot before, const std::string& what) {
  history_.Remember(std::move(before), what);
  PublishHistory();
}

void Workbench::SetForcesOff(bool is_off) {
  forces_off_ = is_off;
  const std::lock_guard lock(mutex_);
  if (run_ != nullptr) {
    run_->StopForces(is_off);
  }
}

Result<void> Workbench::SetDemo(bool is_on) {
  if (!is_on) {
    // A held part is not dropped; a demo that is about to begin ends, too.
    Post([this] { ends_demo_after_step_ = is_demo_.load(); });
    return {};
  }
  auto idle = CheckIdle();
  if (idle) {
    ends_demo_after_step_ = false;
    Post([this] {
      Remember(MakeSnapshot(), "demo");
      Restart(true);
    });
  }
  return idle;
}

Result<void> Workbench::DoNext() {
  auto started = SetDemo(true);
  if (started) {
    ends_demo_after_step_ = true;
  }
  return started;
}

Result<void> Workbench::GoTo(History::Direction direction) {
  auto possible = CheckIdle();
  if (possible) {
    possible = history_.Check(direction);
  }
  if (possible) {
    Post([this, is_undo = direction == History::Direction::kUndo, direction] {
      if (const auto then =
              history_.Go(direction, MakeSnapshot())) {  // empty when another client was faster
        Show(then->scene, then->state, false, is_undo ? "undone" : "done again");
        PublishHistory();
      }
    });
  }
  return possible;
}

Result<void> Workbench::Undo() {
  return GoTo(History::Direction::kUndo);
}

Result<void> Workbench::Redo() {
  return GoTo(History::Direction::kRedo);
}

Result<void> Workbench::Reset() {
  auto idle = CheckIdle();
  if (idle) {
    Post([this] {
      Remember(MakeSnapshot(), "reset");
      Show(scene(), {}, false);
    });
  }
  return idle;
}

Result<void> Workbench::Change(const Edit& edit) {
  if (auto idle = CheckIdle(); !idle) {
    return idle;
  }
  // The edit is tried here first, so that its errors are in the reply.
  product::Product trial = *scene()->model->product;
  auto changed = edit.change(&trial);
  if (changed) {
    Post([this, edit] { DoChange(edit); });
  }
  return changed;
}

void Workbench::DoChange(const Edit& edit) {
  const auto [before, state] = MakeSnapshot();
  const auto after = builder_.Change(*before, edit, MakeProgressListener(edit.what));
  if (!after) {
    Publish({{"event", "failed"}, {"file", edit.what}, {"error", ToJson(after.error())}});
    return;
  }
  Remember(MakeSnapshot(), edit.what);
  // In the new order, parts that are in their place already are skipped.
  const bool has_same_order = HasSameOrder(before->model->sequence, (*after)->model->sequence);
  Show(*after, {state.parts, has_same_order ? state.next_step : 0}, false, edit.what);
}

std::shared_ptr<const OpenScene> Workbench::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

SceneSnapshot Workbench::MakeSnapshot() const {
  const std::lock_guard lock(mutex_);
  return {scene_, run_ != nullptr ? run_->state() : resting_};
}

LiveFrame Workbench::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::optional<simulation::LoopStatus> Workbench::TakeStatus() {
  const std::lock_guard lock(mutex_);
  return run_ != nullptr ? run_->TakeStatus() : std::nullopt;
}

void Workbench::PublishHistory() const {
  Publish(history_.Describe());
}

std::vector<Json> Workbench::MakeCatchUpEvents() const {
  std::vector<Json> news{history_.Describe()};
  if (const auto open = scene()) {
    news.push_back(MakeStepEvent(*open, state().next_step));
  }
  const std::lock_guard lock(mutex_);
  if (scene_ == nullptr && !failure_.is_null()) {
    news.push_back(failure_);
  }
  if (!resumed_.is_null()) {
    news.push_back(resumed_);
  }
  return news;
}

void Workbench::PublishPlacements() const {
  const LiveState now = state();
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    Publish({{"event", "placement"},
             {"occurrence", i},
             {"placement", ToString(now.parts[i].placement)}});
  }
}

}  // namespace hvas::studio
