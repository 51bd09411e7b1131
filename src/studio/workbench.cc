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

Error DemoAtWork() {
  return {ErrorCode::kInvalid, "the simulated person is at work", "", "end the demo first"};
}

Error NothingOpen() {
  return {ErrorCode::kNotFound, "no product is open", "", "open a file or an example first"};
}

const std::string& NameOf(const simulation::Model& model, OccurrenceId id) {
  return model.product->occurrences[id.index()].name;
}

Json MakeStepEvent(const OpenScene& scene, std::size_t step) {
  return {{"event", "step"}, {"index", step}, {"total", scene.model->sequence.steps.size()}};
}

bool HasSameOrder(const simulation::Sequence& a, const simulation::Sequence& b) {
  return std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(),
                    [](const SequenceStep& x, const SequenceStep& y) {
                      return x.kind == y.kind && x.occurrence == y.occurrence;
                    });
}

/** All parts on the table. */
LiveState MakeStart(const simulation::Model& model) {
  LiveState state;
  for (const simulation::Body& body : model.bodies) {
    state.parts.push_back({Placement::kLoose, body.X_WB_start});
  }
  return state;
}

/** @param begun  With parts where a work that was kept had them, or none of them. */
Json MakeResumedEvent(const SceneNow& begun) {
  const auto& parts = begun.state.parts;
  return {{"event", "resumed"},
          {"is_resumed", !parts.empty()},
          {"seated",
           std::count_if(parts.begin(), parts.end(),
                         [](const auto& part) { return part.placement == Placement::kPlaced; })},
          {"edits", begun.scene->edits.size()}};
}

/** Nothing where a part can be taken. */
std::optional<Error> ExplainGone(Placement placement, const std::string& name) {
  switch (placement) {
    case Placement::kPlaced:
      return Error{ErrorCode::kInvalid, "the part stands in its fixture", name,
                   "take the other parts to it"};
    case Placement::kHeld:
      return Error{ErrorCode::kInvalid, "the part is in a hand already", name, "let it go first"};
    default:
      return std::nullopt;
  }
}

std::array<double, 2> SpeedsBetween(const simulation::Frame& before,
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

/** For the list of what can be undone; null for what changed nothing. */
const char* WhatWasDone(const SceneNow& before, const simulation::SimulationEvent& dropped) {
  const bool was_placed =
      before.state.parts[dropped.occurrence.index()].placement == Placement::kPlaced;
  if (dropped.was_seated) {
    return was_placed ? nullptr : "insert";
  }
  return was_placed ? "take out" : "move";
}

bool IsHolding(const LiveRun& run) {
  for (std::size_t hand = 0; hand < run.hand_count(); ++hand) {
    if (run.is_holding(hand)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Workbench::Workbench(WorkbenchOptions options)
    : options_(std::move(options)), builder_(options_.scenes), shelf_(options_.recordings_folder) {}

Workbench::~Workbench() {
  Stop();
}

void Workbench::Stop() {
  worker_.RequestStop();
  Cancel();           // after it: nothing else begins
  FinishRecording();  // before all that may take long
  EndRun();
  sweeper_.Stop();
  worker_.Stop();
  EndRun();  // that the worker had just begun
  FinishRecording();
  if (!std::exchange(has_stopped_, true)) {
    keeper_.Stop();
    DoKeepWork();
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

void Workbench::Tell(Json event) const {
  std::shared_ptr<Recording> recording;
  {
    const std::lock_guard lock(mutex_);
    recording = recording_;
  }
  if (recording != nullptr) {
    recording->AddTold(event);
  }
  if (on_event) {
    on_event(std::move(event));
  }
}

void Workbench::Open(const std::filesystem::path& file, const std::string& name) {
  PostOpen([this, file, name] { DoOpen(file, name, nullptr); });
}

void Workbench::Resume(const KeptWork& work) {
  PostOpen([this, work] { DoOpen(work.file, work.name, &work); });
}

void Workbench::PostOpen(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    opening_.request_stop();  // what is being opened gives way to what comes after it
    opening_ = {};
  }
  Post(std::move(job));
}

void Workbench::Cancel() {
  const std::lock_guard lock(mutex_);
  opening_.request_stop();
}

void Workbench::DoOpen(const std::filesystem::path& file, const std::string& name,
                       const KeptWork* kept) {
  std::stop_token stop;
  {
    const std::lock_guard lock(mutex_);
    stop = opening_.get_token();
  }
  const auto scene = builder_.Open(file, name, TellProgressOf(name), stop);
  if (!scene) {
    Json failed{{"event", "failed"}, {"file", name}, {"error", ToJson(scene.error())}};
    {
      const std::lock_guard lock(mutex_);
      failure_ = failed;
    }
    Tell(std::move(failed));
    return;
  }
  history_.Clear();
  const SceneNow begun = kept != nullptr ? GoOnFrom(*kept, *scene) : SceneNow{*scene, {}};
  {
    const std::lock_guard lock(mutex_);
    failure_ = nullptr;
    resumed_ = kept != nullptr ? MakeResumedEvent(begun) : Json(nullptr);
  }
  if (kept != nullptr && begun.state.parts.empty()) {
    SetWorkAside(options_.work_file);
  }
  Show(begun.scene, begun.state, false);
  paths_.Clear();  // of the product before: its last frame has come
  TellOfHistory();
  if (kept != nullptr) {
    Tell(MakeResumedEvent(begun));
  }
}

SceneNow Workbench::GoOnFrom(const KeptWork& kept, const std::shared_ptr<const OpenScene>& opened) {
  if (opened->digest != kept.digest || opened->model->bodies.size() != kept.state.parts.size()) {
    return {opened, {}};
  }
  SceneNow begun{opened, kept.state};
  if (!kept.edits.empty()) {
    auto edited = builder_.MakeEdits(*opened, kept.edits, TellProgressOf(kept.name));
    if (!edited) {
      return {opened, {}};
    }
    begun.scene = std::move(*edited);
  }
  const std::size_t steps = begun.scene->model->sequence.steps.size();
  begun.state.next_step = std::min(begun.state.next_step, steps);
  return begun;
}

void Workbench::KeepWork() {
  if (!options_.work_file.empty()) {
    (void)keeper_.TryPost([this](const std::stop_token&) { DoKeepWork(); }, 1);
  }
}

void Workbench::DoKeepWork() {
  const SceneNow now = LookAtRest();
  if (options_.work_file.empty() || now.scene == nullptr || trial() != nullptr) {
    return;
  }
  const auto saved = SaveWork(options_.work_file, MakeKeptWork(now));
  if (!saved && std::exchange(can_keep_work_, false)) {
    Tell({{"event", "failed"}, {"file", now.scene->name}, {"error", ToJson(saved.error())}});
  }
  can_keep_work_ = saved.has_value();
}

SceneNow Workbench::LookAtRest() const {
  const std::lock_guard lock(mutex_);
  SceneNow now{scene_, run_ != nullptr ? run_->state() : resting_};
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

cad::ProgressFn Workbench::TellProgressOf(const std::string& name) const {
  return [this, name](std::string_view stage, double fraction) {
    Tell({{"event", "progress"}, {"stage", stage}, {"fraction", fraction}, {"file", name}});
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
    FinishRecording();  // a record is of one scene
  }
  is_demo_ = has_person;  // not before: what the run before told last was still its own
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
    Tell({{"event", "scene"},
          {"epoch", scene->epoch},
          {"why", why.empty() ? Json(nullptr) : Json(why)}});
  } else {
    TellOfPlacements();
  }
  TellOfStep(*scene, run->state().next_step);
  TellOfHands();
  KeepWork();
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
  Tell({{"event", "demo"}, {"on", has_person}});
}

LiveListeners Workbench::MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                       const LiveOptions& live) {
  LiveListeners listeners;
  listeners.on_event = [this, scene](const simulation::SimulationEvent& event) {
    HandleEvent(*scene, event);
  };
  listeners.on_placement = [this](OccurrenceId id, Placement placement) {
    Tell({{"event", "placement"}, {"occurrence", id.value()}, {"placement", ToString(placement)}});
    KeepWork();
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
      const auto speed = SpeedsBetween(frame_.frame, frame);
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
    Tell(std::move(json));
  }
}

void Workbench::HandleHold(const OpenScene& scene, const simulation::SimulationEvent& event) {
  using Kind = simulation::SimulationEvent::Kind;
  if (is_demo_ || (event.kind != Kind::kTaken && event.kind != Kind::kDropped)) {
    return;
  }
  std::optional<SceneNow> before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(before_take_[event.hand], std::nullopt);
    resumed_ = nullptr;
    if (event.kind == Kind::kTaken && run_ != nullptr) {
      before_take_[event.hand] = SceneNow{scene_, run_->state_before_take()};
    }
  }
  const char* what = event.kind == Kind::kDropped && before ? WhatWasDone(*before, event) : nullptr;
  if (what != nullptr) {
    Remember(std::move(*before),
             fmt::format("{} {}", what, NameOf(*scene.model, event.occurrence)));
  }
}

void Workbench::HandleDevice(const simulation::SimulationEvent& event) {
  if (event.kind != simulation::SimulationEvent::Kind::kDevice) {
    return;
  }
  const std::string text = rack_.SetState(event.hand, event.condition, event.vendor_code);
  Tell({{"event", "device"},
        {"hand", event.hand},
        {"condition", device::ToString(event.condition)},
        {"text", text}});
  TellOfHands();
}

void Workbench::TellOfStep(const OpenScene& scene, std::size_t step) const {
  Tell(MakeStepEvent(scene, step));
}

void Workbench::HandleStep(const OpenScene& scene, std::size_t step, bool has_person) {
  TellOfStep(scene, step);
  KeepWork();
  const auto& steps = scene.model->sequence.steps;
  const bool is_finished = step >= steps.size();
  // What stands in a fixture was nobody's work: it ends no demo of one step.
  const bool is_work = step > 0 && steps[step - 1].kind != SequenceStep::Kind::kBase;
  if (has_person && (is_finished || (is_work && ends_demo_after_step_.exchange(false)))) {
    Post([this] { Restart(false); });
  }
}

void Workbench::Remember(SceneNow before, const std::string& what) {
  history_.Remember(std::move(before), what);
  TellOfHistory();
}

Result<void> Workbench::CheckIdle() const {
  const std::lock_guard lock(mutex_);
  if (scene_ == nullptr) {
    return Unexpected(NothingOpen());
  }
  if (is_demo_) {
    return Unexpected(DemoAtWork());
  }
  if (run_ != nullptr && IsHolding(*run_)) {
    return Fail(ErrorCode::kInvalid, "a part is in the hand", "", "let it go first");
  }
  return {};
}

Result<std::shared_ptr<LiveRun>> Workbench::RunForHand(std::size_t hand) const {
  const std::lock_guard lock(mutex_);
  if (scene_ == nullptr) {
    return Unexpected(NothingOpen());
  }
  if (is_demo_) {
    return Unexpected(DemoAtWork());
  }
  if (run_ == nullptr) {
    return Fail(ErrorCode::kInvalid, "the product is just being changed", "", "try again");
  }
  if (hand >= run_->hand_count()) {
    return Fail(ErrorCode::kInvalid, "there is no such hand", fmt::format("hand {}", hand),
                "ask for two hands first");
  }
  if (!run_->hand(hand).follows_pointer()) {
    return Fail(ErrorCode::kInvalid, "a device is in this hand", fmt::format("hand {}", hand),
                "take the part with it, or give the hand back to the pointer");
  }
  return run_;
}

Result<spatial::Pose> Workbench::Take(std::size_t hand, OccurrenceId id) {
  const auto run = RunForHand(hand);
  if (!run) {
    return Unexpected(run.error());
  }
  const simulation::Model& model = (*run)->model();
  if (id.index() >= model.bodies.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such part", fmt::format("o{}", id.value()), "");
  }
  if ((*run)->is_holding(hand)) {
    return Fail(ErrorCode::kInvalid, "a part is in the hand", "", "let it go first");
  }
  const LiveState state = (*run)->state();
  const SequenceStep step = FindStep(model, state, id);
  const simulation::PartState& part = state.parts[step.occurrence.index()];
  const auto gone = ExplainGone(part.placement, NameOf(model, id));
  const bool is_there = step.kind == SequenceStep::Kind::kRemove || !step.members.empty();
  if (gone && (!is_there || part.placement == Placement::kHeld)) {
    return Unexpected(*gone);
  }
  // Upright: what the hand turns, the part turns with it.
  const spatial::Pose X_WH(part.X_WB * simulation::CombineMass(model, step).p_BoBcm_B);
  (*run)->Take(hand, step, X_WH);
  return X_WH;
}

void Workbench::Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping) {
  if (const auto run = RunForHand(hand)) {
    (*run)->Move(hand, X_WH, is_gripping);
  }
}

Result<void> Workbench::Release(std::size_t hand) {
  const auto run = RunForHand(hand);
  if (!run) {
    return Unexpected(run.error());
  }
  const auto& hands = frame().frame.ticks;
  (*run)->Move(hand, hand < hands.size() ? hands[hand].X_WH : spatial::Pose(), false);
  return {};
}

Result<void> Workbench::SetHandCount(std::size_t count) {
  if (count != 1 && count != HandRack::kMostHands) {
    return Fail(ErrorCode::kInvalid, "there are one or two hands", "count", "");
  }
  auto idle = CheckHands();
  if (idle) {
    Post([this, count] {
      if (rack_.count() != count) {
        rack_.SetCount(count);
        RestartWithHands();
      }
    });
  }
  return idle;
}

Result<void> Workbench::UseDevice(std::size_t hand, const std::string& address, double scale) {
  auto idle = CheckHands();
  if (idle) {
    Post([this, hand, address, scale] {
      if (const auto used = rack_.Use(hand, address, scale); !used) {
        Tell({{"event", "failed"}, {"file", address}, {"error", ToJson(used.error())}});
        return;
      }
      RestartWithHands();
    });
  }
  return idle;
}

Result<void> Workbench::CheckHands() const {
  auto idle = CheckIdle();
  return scene() == nullptr ? Result<void>() : idle;
}

void Workbench::RestartWithHands() {
  if (scene() != nullptr) {
    Restart(false);
  } else {
    TellOfHands();
  }
}

void Workbench::SearchDevices() {
  if (device_search_.Begin()) {
    Post([this] {
      device_search_.Run();
      Json event = devices();
      event["event"] = "devices";
      Tell(std::move(event));
    });
  }
}

Json Workbench::devices() const {
  return device_search_.Describe();
}

Json Workbench::hands() const {
  std::shared_ptr<LiveRun> run;
  {
    const std::lock_guard lock(mutex_);
    run = run_;
  }
  std::vector<const haptics::TickOptions*> options;
  for (std::size_t i = 0; run != nullptr && i < run->hand_count(); ++i) {
    options.push_back(&run->hand(i).tick_options());
  }
  return rack_.Describe(options);
}

void Workbench::TellOfHands() const {
  Tell({{"event", "hands"}, {"hands", hands()}});
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
    // A part in the hand is not dropped; a demo that is about to begin ends as well.
    Post([this] { ends_demo_after_step_ = is_demo_.load(); });
    return {};
  }
  auto idle = CheckIdle();
  if (idle) {
    ends_demo_after_step_ = false;
    Post([this] {
      Remember(Look(), "demo");
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
      if (const auto then = history_.Go(direction, Look())) {  // else somebody was faster
        Show(then->scene, then->state, false, is_undo ? "undone" : "done again");
        TellOfHistory();
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
      Remember(Look(), "reset");
      Show(scene(), {}, false);
    });
  }
  return idle;
}

Result<void> Workbench::StartRecording(const std::string& name) {
  if (auto idle = CheckIdle(); !idle) {
    return idle;
  }
  {
    const std::lock_guard lock(mutex_);
    if (recording_ != nullptr) {
      return Fail(ErrorCode::kInvalid, "this is being recorded already", "", "end that first");
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
  const auto [scene, state] = Look();
  if (!recording().is_null()) {
    return;  // somebody was faster
  }
  const std::string called = name.empty() ? shelf_.MakeName(scene->model->product->name) : name;
  auto started = Recording::Start(file, called, scene, MakeSceneJson(*scene, state),
                                  [this] { Post([this] { EndFailedRecording(); }); });
  if (!started) {
    Tell({{"event", "failed"}, {"file", file.string()}, {"error", ToJson(started.error())}});
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    recording_ = *started;
  }
  Restart(false);  // a record begins with how the hands are set up and where all parts are
  TellOfRecording((*started)->Describe());
}

Result<void> Workbench::StopRecording() {
  {
    const std::lock_guard lock(mutex_);
    if (recording_ == nullptr) {
      return Fail(ErrorCode::kInvalid, "nothing is being recorded", "", "");
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
    Tell({{"event", "failed"}, {"file", "recording"}, {"error", ToJson(stopped.error())}});
  }
  TellOfRecording(ended->Describe());
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

void Workbench::TellOfRecording(Json recording) const {
  recording["event"] = "recording";
  Tell(std::move(recording));
  Tell({{"event", "recordings"}});
}

Json Workbench::recording() const {
  const std::lock_guard lock(mutex_);
  return recording_ != nullptr ? recording_->Describe() : Json(nullptr);
}

Result<void> Workbench::RenameRecording(const std::string& id, const std::string& name) {
  auto renamed = shelf_.Rename(id, name);
  if (renamed) {
    Tell({{"event", "recordings"}});
  }
  return renamed;
}

Result<void> Workbench::DeleteRecording(const std::string& id) {
  if (const Json now = recording(); !now.is_null() && now["id"] == id) {
    return Fail(ErrorCode::kInvalid, "this is being recorded", id, "end that first");
  }
  auto deleted = shelf_.Delete(id);
  if (deleted) {
    Tell({{"event", "recordings"}});
  }
  return deleted;
}

Result<void> Workbench::Change(const Edit& edit) {
  if (auto idle = CheckIdle(); !idle) {
    return idle;
  }
  // Tried here first, so that whoever asks learns at once what is wrong with it.
  product::Product trial = *scene()->model->product;
  auto changed = edit.change(&trial);
  if (changed) {
    Post([this, edit] { DoChange(edit); });
  }
  return changed;
}

void Workbench::DoChange(const Edit& edit) {
  const auto [before, state] = Look();
  const auto after = builder_.Change(*before, edit, TellProgressOf(edit.what));
  if (!after) {
    Tell({{"event", "failed"}, {"file", edit.what}, {"error", ToJson(after.error())}});
    return;
  }
  Remember(Look(), edit.what);
  // In another order, what is in its place already is passed over when its turn comes.
  const bool has_same_order = HasSameOrder(before->model->sequence, (*after)->model->sequence);
  Show(*after, {state.parts, has_same_order ? state.next_step : 0}, false, edit.what);
}

std::shared_ptr<const OpenScene> Workbench::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

SceneNow Workbench::Look() const {
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

void Workbench::TellOfHistory() const {
  Tell(history_.Describe());
}

std::vector<Json> Workbench::NewsForLatecomer() const {
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

void Workbench::TellOfPlacements() const {
  const LiveState now = state();
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    Tell({{"event", "placement"},
          {"occurrence", i},
          {"placement", ToString(now.parts[i].placement)}});
  }
}

}  // namespace hvas::studio
