#include "simulation/physics_side.h"

#include <algorithm>

#include "base/check.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

constexpr double kReach = 0.03;  // [m] from a part's centre of mass, to take it up

}  // namespace

PhysicsSide::PhysicsSide(std::shared_ptr<const Model> model,
                         const std::vector<haptics::TickOptions>& hands, Handover* handover,
                         TripleBuffer<Frame>* frames)
    : model_(std::move(model)),
      handover_(*handover),
      frames_(*frames),
      parts_(model_->bodies.size()),
      maker_(*model_, parts_),
      hands_(hands.size()) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].X_WB = model_->bodies[i].X_WB_start;
    parts_[i].placement = BeginningOf(model_->bodies[i].role);
  }
  for (std::size_t i = 0; i < hands.size(); ++i) {
    hands_[i].reports_energy = hands[i].controls_passivity;
  }
}

void PhysicsSide::Restore(const std::vector<PartState>& parts) {
  HVAS_DEMAND(parts.size() == model_->bodies.size());
  parts_ = parts;
  for (PartState& part : parts_) {
    if (part.placement == Placement::kHeld) {
      part.placement = Placement::kLoose;
    }
  }
  PublishFrame();
}

TickCommand PhysicsSide::RemakeCommand(const GivenCommand& given,
                                       std::shared_ptr<const haptics::HeldPart>* held_before) {
  parts_ = given.parts;
  TickCommand command;
  command.kind = given.kind;
  command.hand = given.hand;
  command.other = given.other;
  if (given.kind == TickCommand::Kind::kTake) {
    Hand& hand = hands_[given.hand];
    *held_before = std::exchange(hand.held, maker_.Make(given.step, given.can_join));
    command.part = hand.held.get();
    command.X_WB = hand.held->X_WB_start;
  } else {
    command.body = contact::BodyId(given.step.occurrence.index());
    command.X_WB = parts_[given.step.occurrence.index()].X_WB;
  }
  return command;
}

void PhysicsSide::Step(Sink* sink) {
  FlushCommands();
  SimulationEvent event;
  while (handover_.TryPopEvent(&event)) {
    if (event.kind == SimulationEvent::Kind::kDropped) {
      HandleDrop(event);
    }
    if (sink != nullptr) {
      sink->OnEvent(event);
    }
  }
  for (std::size_t hand = 0; hand < hands_.size(); ++hand) {
    if (handover_.reports[hand].Update()) {
      HandleReport(hand);
    }
    ReportEnergy(hand, sink);
  }
  PublishFrame();
}

void PhysicsSide::HandleReport(std::size_t index) {
  const HandReport& report = handover_.reports[index].value();
  Hand& hand = hands_[index];
  handover_.physics_t_ns.store(report.t_ns, std::memory_order_release);
  if (!report.is_gripping) {
    hand.is_waiting_for_grip_to_open = false;
    hand.helps.reset();
  } else if (hand.held == nullptr && !hand.is_waiting_for_grip_to_open) {
    TakeNearest(index, report.out.X_WH.p());
  }
  for (std::size_t i = 0; i < report.moving_count; ++i) {
    const OccurrenceId id(report.moving[i].body.index());
    if (placement(id) == Placement::kLoose) {
      MoveTogether(id, report.moving[i].X_WB);
    }
  }
  for (std::size_t i = 0; i < report.turned_count; ++i) {
    PartState& part = parts_[report.turned[i].body.index()];
    if (part.placement == Placement::kPlaced) {
      part.X_WB = report.turned[i].X_WB;
    }
  }
}

void PhysicsSide::MoveTogether(OccurrenceId id, const spatial::Pose& X_WB) {
  const std::shared_ptr<const haptics::RigidGroup> group = maker_.GroupOf(ListTogether(parts_, id));
  for (const haptics::RigidGroup::Member& member : group->members) {
    const bool leads = member.body == group->leader();
    parts_[member.body.index()].X_WB = leads ? X_WB : X_WB * member.X_BS;
  }
}

std::vector<const haptics::RigidGroup*> PhysicsSide::ListLooseGroups() {
  std::vector<const haptics::RigidGroup*> groups;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const OccurrenceId id(i);
    if (parts_[i].leader == id && parts_[i].placement == Placement::kLoose) {
      groups.push_back(maker_.GroupOf(ListTogether(parts_, id)).get());
    }
  }
  return groups;
}

void PhysicsSide::ReportEnergy(std::size_t index, Sink* sink) {
  const HandReport& report = handover_.reports[index].value();
  Hand& hand = hands_[index];
  if (!hand.reports_energy || sink == nullptr || report.t_ns < hand.next_energy_ns) {
    return;
  }
  hand.next_energy_ns = report.t_ns + 1'000'000'000;
  SimulationEvent event;
  event.t_ns = report.t_ns;
  event.kind = SimulationEvent::Kind::kEnergy;
  event.hand = index;
  event.occurrence = report.out.occurrence;
  event.state = report.out.state;
  event.energy = report.out.energy;
  event.turning_energy = report.out.turning_energy;
  sink->OnEvent(event);
}

void PhysicsSide::PublishFrame() {
  Frame& frame = frames_.back();
  frame.t_ns = handover_.reports.front().value().t_ns;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    frame.X_WB[i] = parts_[i].X_WB;
  }
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const haptics::TickOutput& tick = handover_.reports[i].value().out;
    const Hand& hand = hands_[i];
    frame.ticks[i] = tick;
    frame.members[i].clear();
    if (hand.held == nullptr || tick.occurrence != hand.held->occurrence) {
      continue;
    }
    frame.X_WB[tick.occurrence.index()] = tick.X_WD;
    for (const haptics::HeldMember& member : hand.held->members) {
      frame.X_WB[member.occurrence.index()] = tick.X_WD * member.X_BS;
      frame.members[i].push_back(member.occurrence);
    }
  }
  frames_.Publish();
}

void PhysicsSide::HandleDrop(const SimulationEvent& event) {
  Hand& hand = hands_[event.hand];
  const sequence::SequenceStep::Kind kind = hand.held_step.kind;
  const bool is_shelf =
      kind == sequence::SequenceStep::Kind::kPark || kind == sequence::SequenceStep::Kind::kAside;
  const auto settle = [&](OccurrenceId id, const spatial::Pose& X_WB) {
    PartState& part = parts_[id.index()];
    part.X_WB = X_WB;
    const bool is_together = part.leader.is_valid() || event.onto.is_valid();
    // A subassembly does not fall apart.
    const bool stays = is_shelf || kind == sequence::SequenceStep::Kind::kReturn ||
                       !hand.held_step.members.empty();
    part.placement = event.was_seated && !is_shelf ? Placement::kPlaced
                     : stays && !is_together       ? Placement::kParked
                                                   : Placement::kLoose;
  };
  settle(event.occurrence, event.X_WB);
  for (const haptics::HeldMember& member : hand.held->members) {
    settle(member.occurrence, event.X_WB * member.X_BS);
  }
  std::vector<OccurrenceId> all =
      event.onto.is_valid() ? ListTogether(parts_, event.onto) : std::vector<OccurrenceId>();
  // Where the other hand has taken of them meanwhile, they have come apart again.
  const bool are_there = std::all_of(all.begin(), all.end(), [this](OccurrenceId id) {
    return placement(id) == Placement::kLoose;
  });
  if (event.onto.is_valid() && are_there) {
    for (const contact::BodyId body : hand.held->bodies) {
      all.emplace_back(body.index());
    }
    JoinParts(all, event.onto, &parts_);
  }
  hand.held = nullptr;
  // Whoever held it as well has it alone now.
  for (Hand& helper : hands_) {
    if (helper.helps == event.hand) {
      helper.helps.reset();
      helper.is_waiting_for_grip_to_open = event.was_seated;
    }
  }
}

void PhysicsSide::PlaceInFixture(OccurrenceId id) {
  if (parts_[id.index()].leader.is_valid()) {
    SeparatePart(id, &parts_);
  }
  PartState& part = parts_[id.index()];
  part.placement = Placement::kPlaced;
  part.X_WB = model_->bodies[id.index()].X_WB_goal;
  // Behind what is still on its way to the haptic thread, which alone writes to its scene.
  TickCommand command;
  command.body = contact::BodyId(id.index());
  command.X_WB = part.X_WB;
  sequence::SequenceStep step;
  step.occurrence = id;
  Send(command, step, false);
}

void PhysicsSide::Send(const TickCommand& command, const sequence::SequenceStep& step,
                       bool can_join) {
  ++given_commands_;
  if (on_command_) {
    on_command_({given_commands_, handover_.physics_t_ns.load(std::memory_order_relaxed),
                 command.kind, command.hand, command.other, step, can_join, parts_});
  }
  waiting_commands_.push_back(command);
  FlushCommands();
}

void PhysicsSide::FlushCommands() {
  while (!waiting_commands_.empty() && handover_.commands.TryPush(waiting_commands_.front())) {
    waiting_commands_.pop_front();
  }
}

OccurrenceId PhysicsSide::FindNearest(const Vec3& p_WH, Placement placement) const {
  OccurrenceId nearest;
  double least = kReach;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].placement != placement) {
      continue;
    }
    const double distance = (parts_[i].X_WB * model_->bodies[i].mass.p_BoBcm_B - p_WH).norm();
    if (distance < least) {
      least = distance;
      nearest = OccurrenceId(i);
    }
  }
  return nearest;
}

bool PhysicsSide::CanTake(const sequence::SequenceStep& step, const Vec3& p_WH) const {
  const Vec3 p_WCm = parts_[step.occurrence.index()].X_WB * CombineMass(*model_, step).p_BoBcm_B;
  if ((p_WCm - p_WH).norm() > kReach) {
    return false;
  }
  const auto is_free = [&](OccurrenceId id) {
    const auto& [placement, X_WB, leader] = parts_[id.index()];
    if (leader.is_valid() && placement == Placement::kLoose) {
      return step.kind == sequence::SequenceStep::Kind::kRemove || !step.members.empty();
    }
    if (sequence::IsWithinProduct(step.kind)) {
      return placement == PlacementBefore(step.kind);
    }
    if (step.kind == sequence::SequenceStep::Kind::kRemove) {
      return placement == Placement::kPlaced;
    }
    return step.members.empty()
               ? placement == Placement::kLoose
               : placement == Placement::kPlaced || placement == Placement::kParked;
  };
  return is_free(step.occurrence) && std::all_of(step.members.begin(), step.members.end(), is_free);
}

bool PhysicsSide::TryHelp(std::size_t index, const Vec3& p_WH) {
  const std::optional<std::size_t> other = std::exchange(hands_[index].helps_next, std::nullopt);
  if (!other || hands_[*other].held == nullptr) {
    return false;
  }
  const haptics::HeldPart& part = *hands_[*other].held;
  const haptics::TickOutput& out = handover_.reports[*other].value().out;
  const bool is_near = (out.X_WD * part.p_BoBcm_B - p_WH).norm() <= kReach;
  if (out.occurrence != part.occurrence || !is_near) {
    return false;
  }
  TickCommand command;
  command.kind = TickCommand::Kind::kHelp;
  command.hand = index;
  command.other = *other;
  sequence::SequenceStep step;
  step.occurrence = part.occurrence;
  Send(command, step, false);
  hands_[index].helps = other;
  hands_[index].is_waiting_for_grip_to_open = true;  // It takes nothing else meanwhile.
  return true;
}

void PhysicsSide::TakeNearest(std::size_t index, const Vec3& p_WH) {
  Hand& hand = hands_[index];
  if (TryHelp(index, p_WH)) {
    return;
  }
  if (hand.prepared && CanTake(*hand.prepared, p_WH)) {
    Take(index, *hand.prepared);
    return;
  }
  if (const OccurrenceId loose = FindNearest(p_WH, Placement::kLoose); loose.is_valid()) {
    if (parts_[loose.index()].leader.is_valid()) {
      Take(index, MakeTableStep(*model_, parts_, loose, TakeExtent::kWhole));
      return;
    }
    const sequence::SequenceStep* insertion = sequence::FindInsertion(model_->sequence, loose);
    sequence::SequenceStep step;
    step.occurrence = loose;
    Take(index, insertion != nullptr ? *insertion : step);
    return;
  }
  const OccurrenceId placed =
      hand.takes_out ? FindNearest(p_WH, Placement::kPlaced) : OccurrenceId();
  if (placed.is_valid() && parts_[placed.index()].leader.is_valid()) {
    Take(index, MakeTableStep(*model_, parts_, placed, TakeExtent::kWhole));
    return;
  }
  if (const sequence::SequenceStep* insertion = sequence::FindInsertion(model_->sequence, placed)) {
    sequence::SequenceStep step = *insertion;
    step.kind = sequence::SequenceStep::Kind::kRemove;
    Take(index, step);
    return;
  }
  hand.is_waiting_for_grip_to_open = true;  // closed on nothing: open before the next try
}

void PhysicsSide::Take(std::size_t index, const sequence::SequenceStep& step) {
  Hand& hand = hands_[index];
  hand.held_step = step;
  hand.held = maker_.Make(step, hand.can_join);
  if (log_ != nullptr) {
    log_->Keep(hand.held);
  }
  TickCommand command;
  command.kind = TickCommand::Kind::kTake;
  command.hand = index;
  command.part = hand.held.get();
  command.X_WB = hand.held->X_WB_start;
  Send(command, step, hand.can_join);
  if (step.members.empty() && parts_[step.occurrence.index()].leader.is_valid()) {
    SeparatePart(step.occurrence, &parts_);  // taken alone out of its subassembly
  }
  const auto mark_held = [this](OccurrenceId id) {
    parts_[id.index()].placement = Placement::kHeld;
  };
  mark_held(step.occurrence);
  for (const OccurrenceId id : step.members) {
    mark_held(id);
  }
}

}  // namespace hvas::simulation
