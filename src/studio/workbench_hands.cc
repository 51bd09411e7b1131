#include "studio/workbench_hands.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "studio/event_json.h"
#include "studio/next_step.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using sequence::SequenceStep;
using simulation::Placement;

/** Explains why a part cannot be taken; none where it can. */
std::optional<Error> ExplainUnavailable(Placement placement, const std::string& name) {
  switch (placement) {
    case Placement::kPlaced:
      return Error{ErrorCode::kInvalid, "the part is fixed", name, "bring the other parts to it"};
    case Placement::kHeld:
      return Error{ErrorCode::kInvalid, "another hand holds the part", name, "release it first"};
    case Placement::kPending:
      return Error{ErrorCode::kInvalid, "the part is still being prepared", name,
                   "take another part meanwhile"};
    case Placement::kLoose:
    case Placement::kParked:
      return std::nullopt;
  }
  return std::nullopt;
}

Json ListIds(const std::vector<OccurrenceId>& ids) {
  Json list = Json::array();
  for (const OccurrenceId id : ids) {
    list.push_back(id.value());
  }
  return list;
}

}  // namespace

Json ToJson(const TakenParts& taken) {
  Json places = Json::array();
  for (const simulation::TablePlace& place : taken.table_places) {
    places.push_back({{"target", ListIds(place.target)},
                      {"goal", ToJson(place.X_WB_goal)},
                      {"way_in", ToJson(place.insertion_W)},
                      {"distance_m", place.engage_distance},
                      {"is_there", place.starts_in_place}});
  }
  return {{"hand", ToJson(taken.X_WH)},
          {"occurrence", taken.step.occurrence.value()},
          {"members", ListIds(taken.step.members)},
          {"way_in", ToJson(Vec3(-taken.step.extraction_W))},
          {"table_places", std::move(places)}};
}

Result<std::shared_ptr<LiveRun>> WorkbenchHands::FindRun(std::size_t hand) const {
  auto run = live_->FindRunForHands();
  if (!run) {
    return run;
  }
  if (hand >= (*run)->hand_count()) {
    return Fail(ErrorCode::kInvalid, "there is no such hand", fmt::format("hand {}", hand),
                "add a hand first");
  }
  if (!(*run)->hand(hand).follows_pointer()) {
    return Fail(ErrorCode::kInvalid, "a device moves this hand", fmt::format("hand {}", hand),
                "take the part with the device, or assign the pointer to the hand");
  }
  return run;
}

Result<TakenParts> WorkbenchHands::Take(std::size_t hand, OccurrenceId id,
                                        simulation::TakeExtent extent) {
  const auto run = FindRun(hand);
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
  const SequenceStep step = FindStep(model, state, id, extent);
  const simulation::PartState& part = state.parts[step.occurrence.index()];
  const auto gone = ExplainUnavailable(part.placement, model.product->occurrences[id.index()].name);
  const bool is_there = step.kind == SequenceStep::Kind::kRemove || IsWithinProduct(step.kind) ||
                        !step.members.empty();
  if (gone && (!is_there || part.placement == Placement::kHeld)) {
    return Unexpected(*gone);
  }
  // The hand goes upright to the part, because the part later turns with the hand.
  const spatial::Pose X_WH(part.X_WB * simulation::CombineMass(model, step).p_BoBcm_B);
  (*run)->Take(hand, step, X_WH);
  return TakenParts{X_WH, step, ListTablePlaces(model, state.parts, step)};
}

void WorkbenchHands::Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping) {
  if (const auto run = FindRun(hand)) {
    (*run)->Move(hand, X_WH, is_gripping);
  }
}

Result<void> WorkbenchHands::Release(std::size_t hand) {
  const auto run = FindRun(hand);
  if (!run) {
    return Unexpected(run.error());
  }
  const auto hands = live_->frame().frame.ticks;
  (*run)->Move(hand, hand < hands.size() ? hands[hand].X_WH : spatial::Pose(), false);
  return {};
}

Result<TakenParts> WorkbenchHands::Help(std::size_t hand, std::size_t other) {
  const auto run = FindPair(other, hand);
  if (!run) {
    return Unexpected(run.error());
  }
  const simulation::Frame frame = live_->frame().frame;
  const haptics::TickOutput& tick = frame.ticks[other];
  const auto holds = [&tick](const haptics::TickOutput& each) {
    return each.occurrence == tick.occurrence;
  };
  if (std::count_if(frame.ticks.begin(), frame.ticks.end(), holds) > 1) {
    return Fail(ErrorCode::kInvalid, "two hands hold the part already",
                fmt::format("hand {}", other), "wait until one of them lets go");
  }
  SequenceStep step;
  step.occurrence = tick.occurrence;
  step.members = frame.members[other];
  const spatial::Pose X_WH(tick.X_WD * simulation::CombineMass((*run)->model(), step).p_BoBcm_B);
  (*run)->Help(hand, other, X_WH);
  return TakenParts{X_WH, step, {}};
}

Result<std::shared_ptr<LiveRun>> WorkbenchHands::FindPair(std::size_t from, std::size_t to) const {
  auto run = FindRun(from);
  if (!run) {
    return run;
  }
  if (const auto other = FindRun(to); !other) {
    return other;
  }
  if (from == to || (*run)->is_holding(to)) {
    return Fail(ErrorCode::kInvalid, "the hand that is to take the part is not free",
                fmt::format("hand {}", to), "release what it holds first");
  }
  const auto ticks = live_->frame().frame.ticks;
  if (!(*run)->is_holding(from) || from >= ticks.size() || !ticks[from].occurrence.is_valid()) {
    return Fail(ErrorCode::kInvalid, "the hand holds nothing", fmt::format("hand {}", from),
                "take a part first");
  }
  return run;
}

Result<void> WorkbenchHands::HandOver(std::size_t from, std::size_t to) {
  const auto run = FindPair(from, to);
  if (!run) {
    return Unexpected(run.error());
  }
  (*run)->HandOver(from, to, live_->frame().frame.ticks[from].occurrence);
  return {};
}

Result<void> WorkbenchHands::SetCount(std::size_t count) {
  if (count < 1 || count > HandRack::kMaxHands) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the number of hands has to be 1 to {}", HandRack::kMaxHands), "count",
                "");
  }
  auto possible = CheckChange();
  if (possible) {
    worker_->Post([this, count](const std::stop_token& /*stop*/) {
      if (rack_.count() != count) {
        is_changing_ = true;
        rack_.SetCount(count);
        Restart();
      }
    });
  }
  return possible;
}

Result<void> WorkbenchHands::UseDevice(std::size_t hand, std::size_t device, double scale) {
  if (device >= devices_.entries().size()) {
    return Fail(ErrorCode::kNotFound, "there is no such device", "device",
                "choose one of the list of devices");
  }
  auto possible = CheckChange();
  if (possible) {
    worker_->Post([this, hand, device, scale](const std::stop_token& /*stop*/) {
      is_changing_ = true;
      const bool is_live = !live_->clock().is_steered();
      if (const auto used = rack_.Use(hand, device, scale, is_live); !used) {
        is_changing_ = false;
        events_->Publish({{"event", "failed"},
                          {"file", devices_.entries()[device].name},
                          {"error", ToJson(used.error())}});
        return;
      }
      Restart();
    });
  }
  return possible;
}

Result<void> WorkbenchHands::CheckChange() const {
  auto idle = live_->CheckIdle();
  return live_->scene() == nullptr ? Result<void>() : idle;
}

void WorkbenchHands::Restart() {
  if (live_->scene() != nullptr) {
    live_->Restart(false);
  } else {
    is_changing_ = false;
    PublishHands();
  }
}

void WorkbenchHands::SearchDevices() {
  if (device_search_.Begin()) {
    search_thread_.Post([this](const std::stop_token& /*stop*/) {
      device_search_.Run();
      Json event = DescribeDevices();
      event["event"] = "devices";
      events_->Publish(event);
    });
  }
}

Json WorkbenchHands::Describe() const {
  const std::shared_ptr<LiveRun> run = live_->run();
  std::vector<const haptics::TickOptions*> options;
  for (std::size_t i = 0; run != nullptr && i < run->hand_count(); ++i) {
    options.push_back(&run->hand(i).tick_options());
  }
  return rack_.Describe(options);
}

void WorkbenchHands::PublishHands() const {
  events_->Publish({{"event", "hands"}, {"hands", Describe()}});
}

void WorkbenchHands::ConfigureRun(const OpenScene& /*scene*/, LiveOptions* live) {
  live->hands = rack_.setups();
  is_changing_ = false;  // the run before has ended
}

void WorkbenchHands::OnRunBegun() {
  PublishHands();
}

void WorkbenchHands::OnEvent(const simulation::SimulationEvent& event) {
  if (event.kind != simulation::SimulationEvent::Kind::kDevice || is_changing_) {
    return;  // what a device reports as its run ends is not about the device that replaces it
  }
  const std::string text = rack_.SetState(event.hand, event.condition, event.vendor_code);
  events_->Publish({{"event", "device"},
                    {"hand", event.hand},
                    {"condition", device::ToString(event.condition)},
                    {"text", text}});
  PublishHands();
}

}  // namespace hvas::studio
