// Hands of the workbench: devices, taking and releasing of parts.

#include <utility>

#include <fmt/format.h>

#include "studio/event_json.h"
#include "studio/next_step.h"
#include "studio/workbench.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using simulation::Placement;
using simulation::SequenceStep;

Error MakeDemoError() {
  return {ErrorCode::kInvalid, "the simulated person is working", "",
          "stop the simulated person first"};
}

Error MakeNoProductError() {
  return {ErrorCode::kNotFound, "no product is open", "", "open a file or an example first"};
}

const std::string& NameOf(const simulation::Model& model, OccurrenceId id) {
  return model.product->occurrences[id.index()].name;
}

/** Explains why a part cannot be taken; none where it can. */
std::optional<Error> ExplainUnavailable(Placement placement, const std::string& name) {
  switch (placement) {
    case Placement::kPlaced:
      return Error{ErrorCode::kInvalid, "the part is fixed", name, "bring the other parts to it"};
    case Placement::kHeld:
      return Error{ErrorCode::kInvalid, "another hand holds the part", name, "release it first"};
    default:
      return std::nullopt;
  }
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

bool IsHolding(const LiveRun& run) {
  for (std::size_t hand = 0; hand < run.hand_count(); ++hand) {
    if (run.is_holding(hand)) {
      return true;
    }
  }
  return false;
}

}  // namespace

Result<void> Workbench::CheckIdle() const {
  const std::lock_guard lock(mutex_);
  if (scene_ == nullptr) {
    return Unexpected(MakeNoProductError());
  }
  if (is_demo_) {
    return Unexpected(MakeDemoError());
  }
  if (run_ != nullptr && IsHolding(*run_)) {
    return Fail(ErrorCode::kInvalid, "the hand holds a part", "", "release it first");
  }
  return {};
}

Result<std::shared_ptr<LiveRun>> Workbench::RunForHand(std::size_t hand) const {
  const std::lock_guard lock(mutex_);
  if (scene_ == nullptr) {
    return Unexpected(MakeNoProductError());
  }
  if (is_demo_) {
    return Unexpected(MakeDemoError());
  }
  if (run_ == nullptr) {
    return Fail(ErrorCode::kInvalid, "the product is being changed", "", "try again");
  }
  if (hand >= run_->hand_count()) {
    return Fail(ErrorCode::kInvalid, "there is no such hand", fmt::format("hand {}", hand),
                "switch to two hands first");
  }
  if (!run_->hand(hand).follows_pointer()) {
    return Fail(ErrorCode::kInvalid, "a device moves this hand", fmt::format("hand {}", hand),
                "take the part with the device, or assign the pointer to the hand");
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
    return Fail(ErrorCode::kInvalid, "the hand holds a part", "", "release it first");
  }
  const LiveState state = (*run)->state();
  const SequenceStep step = FindStep(model, state, id);
  const simulation::PartState& part = state.parts[step.occurrence.index()];
  const auto gone = ExplainUnavailable(part.placement, NameOf(model, id));
  const bool is_there = step.kind == SequenceStep::Kind::kRemove || !step.members.empty();
  if (gone && (!is_there || part.placement == Placement::kHeld)) {
    return Unexpected(*gone);
  }
  // The hand goes upright to the part, because the part later turns with the hand.
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
  if (count != 1 && count != HandRack::kMaxHands) {
    return Fail(ErrorCode::kInvalid, "the number of hands has to be 1 or 2", "count", "");
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
        Publish({{"event", "failed"}, {"file", address}, {"error", ToJson(used.error())}});
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
    PublishHands();
  }
}

void Workbench::SearchDevices() {
  if (device_search_.Begin()) {
    Post([this] {
      device_search_.Run();
      Json event = devices();
      event["event"] = "devices";
      Publish(std::move(event));
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

void Workbench::PublishHands() const {
  Publish({{"event", "hands"}, {"hands", hands()}});
}

void Workbench::HandleHold(const OpenScene& scene, const simulation::SimulationEvent& event) {
  using Kind = simulation::SimulationEvent::Kind;
  if (is_demo_ || (event.kind != Kind::kTaken && event.kind != Kind::kDropped)) {
    return;
  }
  std::optional<SceneSnapshot> before;
  {
    const std::lock_guard lock(mutex_);
    before = std::exchange(before_take_[event.hand], std::nullopt);
    resumed_ = nullptr;
    if (event.kind == Kind::kTaken && run_ != nullptr) {
      before_take_[event.hand] = SceneSnapshot{scene_, run_->state_before_take()};
    }
  }
  const char* what =
      event.kind == Kind::kDropped && before ? DescribeRelease(*before, event) : nullptr;
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
  Publish({{"event", "device"},
           {"hand", event.hand},
           {"condition", device::ToString(event.condition)},
           {"text", text}});
  PublishHands();
}

}  // namespace hvas::studio
