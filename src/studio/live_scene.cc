#include "studio/live_scene.h"

#include <utility>

#include "simulation/table_subassembly.h"
#include "studio/event_json.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using simulation::Placement;

Json MakeStepEvent(const OpenScene& scene, std::size_t step) {
  const std::size_t pending = simulation::CountPending(*scene.model);
  return {
      {"event", "step"}, {"index", step}, {"total", scene.model->sequence.steps.size() + pending}};
}

Json MakePlacementEvent(std::size_t occurrence, const simulation::PartState& part) {
  Json event{
      {"event", "placement"}, {"occurrence", occurrence}, {"placement", ToString(part.placement)}};
  if (part.leader.is_valid()) {
    event["leader"] = part.leader.value();
  }
  return event;
}

std::array<double, haptics::kMaxHands> CalcHandSpeeds(const simulation::Frame& before,
                                                      const simulation::Frame& after) {
  std::array<double, haptics::kMaxHands> speeds{};
  const double elapsed = 1e-9 * static_cast<double>(after.t_ns - before.t_ns);
  for (std::size_t i = 0; i < after.ticks.size(); ++i) {
    if (i < before.ticks.size() && elapsed > 0) {
      speeds[i] = (after.ticks[i].X_WH.p() - before.ticks[i].X_WH.p()).norm() / elapsed;
    }
  }
  return speeds;
}

/** Puts a part together again with the parts that it was together with before. */
void RejoinParts(const std::vector<simulation::PartState>& before, OccurrenceId id,
                 std::vector<simulation::PartState>* parts) {
  const OccurrenceId leader = before[id.index()].leader;
  if (leader.is_valid()) {
    simulation::JoinParts(simulation::ListTogether(before, id), leader, parts);
  }
}

bool IsHolding(const LiveRun& run) {
  for (std::size_t hand = 0; hand < run.hand_count(); ++hand) {
    if (run.is_holding(hand)) {
      return true;
    }
  }
  return false;
}

Unexpected FailNothingOpen() {
  return Fail(ErrorCode::kNotFound, "no product is open", "", "open a file or an example first");
}

}  // namespace

void LiveScene::Show(const std::shared_ptr<const OpenScene>& scene, const LiveState& state,
                     bool has_person, const std::string& why) {
  std::shared_ptr<LiveRun> ended;
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    ended = std::exchange(run_, nullptr);
    is_new = scene_ != scene;
    scene_ = scene;
    resting_ = state.parts.empty() ? MakeStart(*scene->model) : state;
    before_take_ = {};
  }
  ended.reset();  // its threads end here, outside the lock that they may wait for
  LiveOptions live;
  live.has_person = has_person;
  live.seed = options_.seed;
  live.rate_hz = options_.rate_hz;
  live.guidance = options_.guidance;
  live.clock = options_.clock;
  live.forces_off = forces_off_;
  for (SceneObserver* observer : observers_) {
    observer->ConfigureRun(*scene, &live);
  }
  is_demo_ = has_person;  // after the last events of the previous run
  auto run = std::make_shared<LiveRun>(scene->model, state, live, MakeListeners(scene, live));
  {
    const std::lock_guard lock(mutex_);
    run->StopForces(forces_off_);  // under the lock, so that no call of SetForcesOff() is missed
    run_ = run;
  }
  if (is_new) {
    events_->Publish({{"event", "scene"},
                      {"epoch", scene->epoch},
                      {"why", why.empty() ? Json(nullptr) : Json(why)}});
  } else {
    PublishPlacements();
  }
  events_->Publish(MakeStepEvent(*scene, run->state().next_step));
  for (SceneObserver* observer : observers_) {
    observer->OnRunBegun();
  }
}

void LiveScene::Restart(bool has_person) {
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
  events_->Publish({{"event", "demo"}, {"on", has_person}});
}

void LiveScene::EndRun() {
  std::shared_ptr<LiveRun> ended;
  {
    const std::lock_guard lock(mutex_);
    if (run_ == nullptr) {
      return;
    }
    resting_ = run_->state();
    ended = std::exchange(run_, nullptr);
  }
  ended.reset();  // its threads end here, outside the lock that they may wait for
  is_demo_ = false;
}

LiveListeners LiveScene::MakeListeners(const std::shared_ptr<const OpenScene>& scene,
                                       const LiveOptions& live) {
  LiveListeners listeners;
  listeners.on_event = [this](const simulation::SimulationEvent& event) { HandleEvent(event); };
  listeners.on_placement = [this](OccurrenceId id, const simulation::PartState& part) {
    events_->Publish(MakePlacementEvent(id.value(), part));
    for (SceneObserver* observer : observers_) {
      observer->OnPlacement();
    }
  };
  listeners.on_step = [this, scene, has_person = live.has_person](std::size_t step) {
    HandleStep(*scene, step, has_person);
  };
  listeners.on_removal = [this](bool is_last) {
    for (SceneObserver* observer : observers_) {
      observer->OnRemoval(is_last);
    }
  };
  listeners.on_frame = [this, scene, recording = live.recording](const simulation::Frame& frame,
                                                                 std::int64_t clock_ns,
                                                                 const PeakForces& peak_felt) {
    const simulation::Model& model = *scene->model;
    std::vector<double> deformations =
        simulation::CalcDeformations(*model.product, model.deformables, frame.X_WB);
    LiveFrame shown;
    {
      const std::lock_guard lock(mutex_);
      const auto speed = CalcHandSpeeds(frame_.frame, frame);
      frame_ = {scene->epoch, frame_.serial + 1,      frame, clock_ns, peak_felt,
                speed,        std::move(deformations)};
      shown = recording != nullptr ? frame_ : LiveFrame();
    }
    if (recording != nullptr) {
      recording->AddFrame(shown);
    }
    for (SceneObserver* observer : observers_) {
      observer->OnFrame(frame);
    }
  };
  return listeners;
}

void LiveScene::HandleEvent(const simulation::SimulationEvent& event) {
  HandleHold(event);
  for (SceneObserver* observer : observers_) {
    observer->OnEvent(event);
  }
  if (const Json json = ToJson(event); !json.is_null()) {
    events_->Publish(json);
  }
}

void LiveScene::HandleHold(const simulation::SimulationEvent& event) {
  using Kind = simulation::SimulationEvent::Kind;
  if (is_demo_ || (event.kind != Kind::kTaken && event.kind != Kind::kDropped)) {
    return;
  }
  std::optional<SceneSnapshot> before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(before_take_[event.hand], std::nullopt);
    if (event.kind == Kind::kTaken && run_ != nullptr) {
      before_take_[event.hand] = SceneSnapshot{scene_, run_->state_before_take()};
    }
  }
  for (SceneObserver* observer : observers_) {
    observer->OnHold(event, before);
  }
}

void LiveScene::HandleStep(const OpenScene& scene, std::size_t step, bool has_person) {
  events_->Publish(MakeStepEvent(scene, step));
  for (SceneObserver* observer : observers_) {
    observer->OnStep(scene, step, has_person);
  }
}

void LiveScene::SetForcesOff(bool is_off) {
  forces_off_ = is_off;
  const std::lock_guard lock(mutex_);
  if (run_ != nullptr) {
    run_->StopForces(is_off);
  }
}

std::shared_ptr<const OpenScene> LiveScene::scene() const {
  const std::lock_guard lock(mutex_);
  return scene_;
}

SceneSnapshot LiveScene::MakeSnapshot() const {
  const std::lock_guard lock(mutex_);
  return {scene_, run_ != nullptr ? run_->state() : resting_};
}

SceneSnapshot LiveScene::MakeRestingSnapshot() const {
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
        RejoinParts(before->state.parts, OccurrenceId(i), &now.state.parts);
      }
    }
  }
  return now;
}

LiveFrame LiveScene::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::optional<simulation::LoopStatus> LiveScene::TakeStatus() {
  const std::lock_guard lock(mutex_);
  return run_ != nullptr ? run_->TakeStatus() : std::nullopt;
}

Json LiveScene::DescribeStep() const {
  const SceneSnapshot now = MakeSnapshot();
  return now.scene != nullptr ? MakeStepEvent(*now.scene, now.state.next_step) : Json(nullptr);
}

Result<std::shared_ptr<const OpenScene>> LiveScene::FindScene() const {
  auto open = scene();
  return open != nullptr ? Result<std::shared_ptr<const OpenScene>>(std::move(open))
                         : FailNothingOpen();
}

Result<void> LiveScene::CheckOpen() const {
  if (scene_ == nullptr) {
    return FailNothingOpen();
  }
  if (is_demo_) {
    return Fail(ErrorCode::kInvalid, "the simulated person is working", "",
                "stop the simulated person first");
  }
  return {};
}

bool LiveScene::is_holding() const {
  const std::lock_guard lock(mutex_);
  return run_ != nullptr && IsHolding(*run_);
}

std::optional<std::int64_t> LiveScene::FindOldestInput() const {
  const std::lock_guard lock(mutex_);
  return run_ != nullptr ? run_->FindOldestInput() : std::nullopt;
}

Result<void> LiveScene::CheckIdle() const {
  const std::lock_guard lock(mutex_);
  auto open = CheckOpen();
  if (open && simulation::CountPending(*scene_->model) > 0) {
    return Fail(ErrorCode::kInvalid, "the product is still being prepared", scene_->name,
                "wait until all its parts are ready; meanwhile, take those that are");
  }
  if (open && run_ != nullptr && IsHolding(*run_)) {
    return Fail(ErrorCode::kInvalid, "the hand holds a part", "", "release it first");
  }
  return open;
}

std::shared_ptr<LiveRun> LiveScene::run() const {
  const std::lock_guard lock(mutex_);
  return run_;
}

Result<std::shared_ptr<LiveRun>> LiveScene::FindRunForHands() const {
  const std::lock_guard lock(mutex_);
  if (const auto open = CheckOpen(); !open) {
    return Unexpected(open.error());
  }
  if (run_ == nullptr) {
    return Fail(ErrorCode::kInvalid, "the product is being changed", "", "try again");
  }
  return run_;
}

void LiveScene::PublishPlacements() const {
  const LiveState now = state();
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    events_->Publish(MakePlacementEvent(i, now.parts[i]));
  }
}

}  // namespace hvas::studio
