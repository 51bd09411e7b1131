#include "simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "fits/paper_scales.h"
#include "mates/resolve.h"
#include "simulation/fit_of_mate.h"

namespace hvas::simulation {
namespace {

using product::MateKind;
using product::OccurrenceId;

constexpr double kReach = 0.03;     // [m] from a part's centre of mass, to take it up
constexpr double kApproach = 0.01;  // [m] before its place, where a part's mates are resolved from
// Of the ring of events: a taking and a letting go of each of two hands.
constexpr std::size_t kRoomForOwnership = 4;
constexpr double kStopCosine = 0.5;  // a plane facing the way in ends it; one along it guides

double PaperFactorOf(const product::Mate& mate) {
  if (!mate.fit || mate.fit->kind == product::FitKind::kThread) {
    return 1;
  }
  switch (mate.fit->kind) {
    case product::FitKind::kInterference:
      return fits::FindPaperScale(fits::FitKind::kInterference).factor;
    case product::FitKind::kTransition:
      return fits::FindPaperScale(fits::FitKind::kTransition).factor;
    default:
      return fits::FindPaperScale(fits::FitKind::kClearance).factor;
  }
}

Frame MakeFirstFrame(const Model& model, std::size_t hands) {
  Frame frame;
  frame.ticks.resize(hands);
  for (const Body& body : model.bodies) {
    frame.X_WB.push_back(body.X_WB_start);
  }
  return frame;
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& options)
    : Simulation(std::move(model), &options, 1) {}

Simulation::Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions& first,
                       const haptics::TickOptions& second)
    : Simulation(std::move(model), std::array{first, second}.data(), 2) {}

Simulation::Simulation(std::shared_ptr<const Model> model, const haptics::TickOptions* options,
                       std::size_t hands)
    : model_(std::move(model)),
      commands_(4 * model_->bodies.size() + 64),
      events_(256),
      frames_(MakeFirstFrame(*model_, hands)),
      parts_(model_->bodies.size()) {
  for (std::size_t i = 0; i < hands; ++i) {
    hands_.emplace_back(i, options[i], &scene_);
  }
  if (hands_.size() == 2) {
    hands_[0].haptic.ShareSceneWith(&hands_[1].haptic, true);
    hands_[1].haptic.ShareSceneWith(&hands_[0].haptic, false);
  }
  for (const Body& body : model_->bodies) {
    const contact::BodyId id = scene_.Add(body.shape, body.X_WB_start);
    scene_.SetOffsets(id, body.faces);
    PartState& part = parts_[id.index()];
    part.X_WB = body.X_WB_start;
    for (Hand& hand : hands_) {
      hand.haptic.SetProperties(id,
                                {body.mass.mass, body.mass.p_BoBcm_B, body.mass.I_BBcm_B,
                                 SurfaceOf(model_->product->part_of(body.occurrence).material)});
      hand.haptic.SetLoose(id, true);
    }
  }
  scene_.SetGround(model_->table_z);
}

void Simulation::Restore(const std::vector<PartState>& parts) {
  HVAS_DEMAND(parts.size() == model_->bodies.size());
  parts_ = parts;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    PartState& part = parts_[i];
    if (part.placement == Placement::kHeld) {
      part.placement = Placement::kLoose;
    }
    const contact::BodyId id(i);
    scene_.SetPose(id, part.X_WB);
    for (Hand& hand : hands_) {
      hand.haptic.SetLoose(id, part.placement == Placement::kLoose);
    }
  }
  FillFrame(&frames_.back());
  frames_.Publish();
}

void Simulation::SetEffortLevel(int level) noexcept {
  effort_level_ = level;
  for (Hand& hand : hands_) {
    hand.haptic.SetEffort(kEffortLevels[static_cast<std::size_t>(level)]);
  }
}

/** There is always room for it: a hand has at most one taking and one letting go on the way, as
 physics gives it the next part only when it has seen both. */
void Simulation::PushOwnership(const SimulationEvent& event) noexcept {
  events_.TryPush(event);
}

/** @returns false where nothing but the room for ownership is left. */
bool Simulation::TryPushTelemetry(const SimulationEvent& event) noexcept {
  return events_.TryPush(event, kRoomForOwnership);
}

void Simulation::Obey(const TickCommand& command, std::int64_t t_ns) noexcept {
  if (command.kind == TickCommand::Kind::kTake) {
    Hand& hand = hands_[command.hand];
    hand.haptic.Take(command.part);
    hand.metrics = {};
    hand.metrics.t_taken_ns = t_ns;
    hand.last_contact_ns = t_ns;  // it is taken off what it lies on
    hand.p_last_Cm = command.X_WB * command.part->p_BoBcm_B;
    SimulationEvent event;
    event.t_ns = t_ns;
    event.kind = SimulationEvent::Kind::kTaken;
    event.hand = hand.index;
    event.occurrence = command.part->occurrence;
    event.state = haptics::HoldState::kFree;
    event.X_WB = command.X_WB;
    event.metrics = hand.metrics;
    PushOwnership(event);
  } else {
    for (Hand& hand : hands_) {
      hand.haptic.SetLoose(command.body, false);
    }
    scene_.SetPose(command.body, command.X_WB);
  }
}

haptics::TickOutput Simulation::HapticTick(std::size_t hand,
                                           const device::DeviceState& device) noexcept {
  TickCommand command;
  while (commands_.TryPop(&command)) {
    if (log_ != nullptr) {
      log_->Add(command);
    }
    Obey(command, device.t_ns);
    ++obeyed_commands_;
  }
  haptics::TickContext context;
  context.model_age_ns = device.t_ns - physics_t_ns_.load(std::memory_order_acquire);
  context.is_stopped = is_stopped_.load(std::memory_order_acquire);
  context.effort_level = effort_level_;
  haptics::TickOutput out = RunTick(&hands_[hand], device, context);
  if (log_ != nullptr) {
    log_->Add({device, context.model_age_ns, context.is_stopped,
               static_cast<std::uint8_t>(effort_level_), static_cast<std::uint8_t>(hand), 0,
               out.F_H_D});
  }
  return out;
}

haptics::TickOutput Simulation::ReplayTick(const TickLog& log, std::size_t i) noexcept {
  const TickLog::Tick& tick = log.tick(i);
  for (; replayed_commands_ < log.command_count() && log.command(replayed_commands_).tick <= i;
       ++replayed_commands_) {
    Obey(log.command(replayed_commands_).command, tick.device.t_ns);
  }
  haptics::TickContext context;
  context.model_age_ns = tick.model_age_ns;
  context.is_stopped = tick.is_stopped;
  context.effort_level = tick.effort_level;
  return ReplayTick(tick.hand, tick.device, context);
}

haptics::TickOutput Simulation::ReplayTick(std::size_t hand, const device::DeviceState& device,
                                           const haptics::TickContext& context) noexcept {
  SetEffortLevel(context.effort_level);
  return RunTick(&hands_[hand], device, context);
}

void Simulation::ReplayCommand(const GivenCommand& given, std::int64_t t_ns) {
  parts_ = given.parts;
  TickCommand command;
  command.kind = given.kind;
  command.hand = given.hand;
  std::shared_ptr<const haptics::HeldPart> held_before;  // until the tick has let go of it
  if (given.kind == TickCommand::Kind::kTake) {
    Hand& hand = hands_[given.hand];
    held_before = std::exchange(hand.held, MakeHeldPart(given.step));
    command.part = hand.held.get();
    command.X_WB = hand.held->X_WB_start;
  } else {
    command.body = contact::BodyId(given.step.occurrence.index());
    command.X_WB = parts_[given.step.occurrence.index()].X_WB;
  }
  Obey(command, t_ns);
}

void Simulation::TellOfSafety(Hand* hand, const device::DeviceState& device,
                              const haptics::TickOutput& out) noexcept {
  constexpr std::int64_t kQuietNs = 1'000'000'000;  // an action that goes on is one event
  SimulationEvent event;
  event.t_ns = device.t_ns;
  event.hand = hand->index;
  event.occurrence = out.occurrence;
  event.state = out.state;
  for (std::size_t bit = 0; bit < hand->last_action_ns.size(); ++bit) {
    if ((out.gate_actions >> bit & 1u) == 0) {
      continue;
    }
    std::int64_t& last_ns = hand->last_action_ns[bit];
    if (last_ns == 0 || device.t_ns - last_ns > kQuietNs) {
      event.gate_actions |= 1u << bit;
    }
    last_ns = device.t_ns;
  }
  if (event.gate_actions != 0) {
    event.kind = SimulationEvent::Kind::kSafety;
    if (!TryPushTelemetry(event)) {
      lost_events_.fetch_add(1, std::memory_order_relaxed);
    }
  }
  if (effort_level_ != told_effort_level_) {
    event.kind = SimulationEvent::Kind::kEffort;
    event.effort_level = effort_level_;
    if (TryPushTelemetry(event)) {  // Else it is said again in the next tick.
      told_effort_level_ = effort_level_;
    }
  }
  if (device.condition != hand->last_condition) {
    event.kind = SimulationEvent::Kind::kDevice;
    event.condition = device.condition;
    event.vendor_code = device.vendor_code;
    if (TryPushTelemetry(event)) {
      hand->last_condition = device.condition;
    }
  }
}

haptics::TickOutput Simulation::RunTick(Hand* hand, const device::DeviceState& device,
                                        const haptics::TickContext& context) noexcept {
  haptics::HapticTick& haptic = hand->haptic;
  if (haptic.held() != nullptr && device.is_valid && !device.is_gripping) {
    const haptics::HeldPart& part = *haptic.held();
    const haptics::LetGo let_go = haptic.Drop();
    SimulationEvent event;
    event.t_ns = device.t_ns;
    event.kind = SimulationEvent::Kind::kDropped;
    event.hand = hand->index;
    event.occurrence = part.occurrence;
    event.state = haptics::HoldState::kEmpty;
    event.X_WB = let_go.X_WB;
    event.was_seated = let_go.is_in_place;
    event.to_place = let_go.to_place;
    event.metrics = hand->metrics;
    PushOwnership(event);
  }
  haptics::TickOutput out = haptic.Tick(device, context);
  Measure(hand, device.t_ns, out);
  if (out.state != hand->last_state) {
    SimulationEvent event;
    event.t_ns = device.t_ns;
    event.hand = hand->index;
    event.occurrence = out.occurrence;
    event.state = out.state;
    event.X_WB = out.X_WD;
    event.metrics = hand->metrics;
    if (TryPushTelemetry(event)) {
      hand->last_state = out.state;
    }
  }
  TellOfSafety(hand, device, out);
  Report report{device.t_ns, device.is_gripping && device.is_valid, out, {}, 0};
  for (const haptics::FreeBody& body : std::as_const(haptic).awake()) {
    report.moving[report.moving_count++] = {body.id, body.X_WB};
  }
  hand->reports.Write(report);
  return out;
}

void Simulation::Measure(Hand* hand, std::int64_t t_ns, const haptics::TickOutput& out) noexcept {
  if (hand->haptic.held() == nullptr) {
    return;
  }
  HoldMetrics& metrics = hand->metrics;
  const Vec3 p_Cm = out.X_WD * hand->haptic.held()->p_BoBcm_B;
  metrics.path += (p_Cm - hand->p_last_Cm).norm();
  hand->p_last_Cm = p_Cm;
  metrics.peak_true = std::max(metrics.peak_true, out.F_true_W.f.norm());
  metrics.peak_felt = std::max(metrics.peak_felt, out.F_H_W.f.norm());
  metrics.fit_true = std::max(metrics.fit_true, std::abs(out.axial_true));
  metrics.fit_felt = std::max(metrics.fit_felt, std::abs(out.axial_felt));
  metrics.deepest = std::max(metrics.deepest, -out.deepest);
  metrics.insertion = std::max(metrics.insertion, out.insertion_depth);
  if (out.contact_count > 0) {
    constexpr std::int64_t kApartNs = 100'000'000;  // what touches again sooner has not let go
    const bool is_new = t_ns - hand->last_contact_ns > kApartNs;
    metrics.collisions += is_new && out.state < haptics::HoldState::kCaptured ? 1 : 0;
    hand->last_contact_ns = t_ns;
  }
  const double force = out.f_C_W.norm();
  if (out.contact_count > 0 && out.contact_body.is_valid() && force > metrics.hardest_force) {
    metrics.hardest_force = force;
    metrics.hardest = out.contact_body;
  }
}

void Simulation::PhysicsStep(Sink* sink) {
  PassCommands();
  SimulationEvent event;
  while (events_.TryPop(&event)) {
    HandleEvent(event);
    if (sink != nullptr) {
      sink->OnEvent(event);
    }
  }
  for (Hand& hand : hands_) {
    if (hand.reports.Update()) {
      Heed(&hand);
    }
    TellOfEnergy(&hand, sink);
  }
  FillFrame(&frames_.back());
  frames_.Publish();
}

void Simulation::Heed(Hand* hand) {
  const Report& report = hand->reports.value();
  physics_t_ns_.store(report.t_ns, std::memory_order_release);
  if (!report.is_gripping) {
    hand->is_waiting_for_grip_to_open = false;
  } else if (hand->held == nullptr && !hand->is_waiting_for_grip_to_open) {
    TakeNearest(hand, report.out.X_WH.p());
  }
  for (std::size_t i = 0; i < report.moving_count; ++i) {
    PartState& part = parts_[report.moving[i].body.index()];
    if (part.placement == Placement::kLoose) {
      part.X_WB = report.moving[i].X_WB;
    }
  }
}

void Simulation::TellOfEnergy(Hand* hand, Sink* sink) {
  const Report& report = hand->reports.value();
  if (!hand->haptic.options().controls_passivity || sink == nullptr ||
      report.t_ns < hand->next_energy_ns) {
    return;
  }
  hand->next_energy_ns = report.t_ns + 1'000'000'000;
  SimulationEvent event;
  event.t_ns = report.t_ns;
  event.kind = SimulationEvent::Kind::kEnergy;
  event.hand = hand->index;
  event.occurrence = report.out.occurrence;
  event.state = report.out.state;
  event.energy = report.out.energy;
  event.turning_energy = report.out.turning_energy;
  sink->OnEvent(event);
}

void Simulation::FillFrame(Frame* frame) const {
  frame->t_ns = hands_.front().reports.value().t_ns;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    frame->X_WB[i] = parts_[i].X_WB;
  }
  for (const Hand& hand : hands_) {
    const haptics::TickOutput& tick = hand.reports.value().out;
    frame->ticks[hand.index] = tick;
    if (hand.held == nullptr || tick.occurrence != hand.held->occurrence) {
      continue;
    }
    frame->X_WB[tick.occurrence.index()] = tick.X_WD;
    for (const haptics::HeldMember& member : hand.held->members) {
      frame->X_WB[member.occurrence.index()] = tick.X_WD * member.X_BS;
    }
  }
}

const Frame& Simulation::Publish() {
  frames_.Update();
  return frames_.value();
}

void Simulation::HandleEvent(const SimulationEvent& event) {
  if (event.kind != SimulationEvent::Kind::kDropped) {
    return;
  }
  Hand& hand = hands_[event.hand];
  const bool is_shelf = hand.held_step.kind == SequenceStep::Kind::kPark;
  const auto settle = [&](OccurrenceId id, const spatial::Pose& X_WB) {
    PartState& part = parts_[id.index()];
    part.X_WB = X_WB;
    if (event.was_seated && !is_shelf) {
      part.placement = Placement::kPlaced;
    } else if (is_shelf || !hand.held_step.members.empty()) {
      part.placement = Placement::kParked;  // a subassembly does not fall apart
    } else {
      part.placement = Placement::kLoose;
    }
  };
  settle(event.occurrence, event.X_WB);
  for (const haptics::HeldMember& member : hand.held->members) {
    settle(member.occurrence, event.X_WB * member.X_BS);
  }
  hand.held = nullptr;
}

void Simulation::PlaceInFixture(OccurrenceId id) {
  PartState& part = parts_[id.index()];
  part.placement = Placement::kPlaced;
  part.X_WB = model_->bodies[id.index()].X_WB_goal;
  // Behind what is still on its way to the haptic thread, which alone writes to its scene.
  TickCommand command;
  command.body = contact::BodyId(id.index());
  command.X_WB = part.X_WB;
  SequenceStep step;
  step.occurrence = id;
  Give(command, step);
}

void Simulation::Give(const TickCommand& command, const SequenceStep& step) {
  ++given_commands_;
  if (tell_of_command_) {
    tell_of_command_({given_commands_, physics_t_ns_.load(std::memory_order_relaxed), command.kind,
                      command.hand, step, parts_});
  }
  waiting_commands_.push_back(command);
  PassCommands();
}

void Simulation::PassCommands() {
  while (!waiting_commands_.empty() && commands_.TryPush(waiting_commands_.front())) {
    waiting_commands_.pop_front();
  }
}

OccurrenceId Simulation::FindNearest(const Vec3& p_WH, Placement placement) const {
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

bool Simulation::CanTake(const SequenceStep& step, const Vec3& p_WH) const {
  const Vec3 p_WCm = parts_[step.occurrence.index()].X_WB * CombineMass(*model_, step).p_BoBcm_B;
  if ((p_WCm - p_WH).norm() > kReach) {
    return false;
  }
  const auto is_free = [&](OccurrenceId id) {
    const Placement placement = parts_[id.index()].placement;
    if (step.kind == SequenceStep::Kind::kRemove) {
      return placement == Placement::kPlaced;
    }
    return step.members.empty()
               ? placement == Placement::kLoose
               : placement == Placement::kPlaced || placement == Placement::kParked;
  };
  return is_free(step.occurrence) && std::all_of(step.members.begin(), step.members.end(), is_free);
}

void Simulation::TakeNearest(Hand* hand, const Vec3& p_WH) {
  if (hand->prepared && CanTake(*hand->prepared, p_WH)) {
    Take(hand, *hand->prepared);
    return;
  }
  if (const OccurrenceId loose = FindNearest(p_WH, Placement::kLoose); loose.is_valid()) {
    const SequenceStep* insertion = FindInsertion(model_->sequence, loose);
    SequenceStep step;
    step.occurrence = loose;
    Take(hand, insertion != nullptr ? *insertion : step);
    return;
  }
  const OccurrenceId placed =
      hand->takes_out ? FindNearest(p_WH, Placement::kPlaced) : OccurrenceId();
  if (const SequenceStep* insertion = FindInsertion(model_->sequence, placed)) {
    SequenceStep step = *insertion;
    step.kind = SequenceStep::Kind::kRemove;
    Take(hand, step);
    return;
  }
  hand->is_waiting_for_grip_to_open = true;  // closed on nothing: open before the next try
}

void Simulation::Take(Hand* hand, const SequenceStep& step) {
  hand->held_step = step;
  hand->held = MakeHeldPart(step);
  if (log_ != nullptr) {
    log_->Keep(hand->held);
  }
  TickCommand command;
  command.kind = TickCommand::Kind::kTake;
  command.hand = hand->index;
  command.part = hand->held.get();
  command.X_WB = hand->held->X_WB_start;
  Give(command, step);
  const auto mark_held = [this](OccurrenceId id) {
    parts_[id.index()].placement = Placement::kHeld;
  };
  mark_held(step.occurrence);
  for (const OccurrenceId id : step.members) {
    mark_held(id);
  }
}

std::vector<contact::BodyId> Simulation::LeftOut(OccurrenceId id, const SequenceStep& step) const {
  std::vector<contact::BodyId> bodies;
  for (const DrawnOverlap& overlap : model_->sequence.overlaps) {
    if (overlap.a == id || overlap.b == id) {
      bodies.emplace_back((overlap.a == id ? overlap.b : overlap.a).index());
    }
  }
  if (!step.members.empty()) {
    bodies.emplace_back(step.occurrence.index());
    for (const OccurrenceId member : step.members) {
      bodies.emplace_back(member.index());
    }
  }
  return bodies;
}

void Simulation::AddMembers(const SequenceStep& step, haptics::HeldPart* held) const {
  const spatial::Pose X_BW = model_->bodies[step.occurrence.index()].X_WB_goal.Inverse();
  for (const OccurrenceId id : step.members) {
    haptics::HeldMember member;
    member.occurrence = id;
    member.body = contact::BodyId(id.index());
    member.shape = model_->bodies[id.index()].shape;
    member.X_BS = X_BW * model_->bodies[id.index()].X_WB_goal;
    member.left_out = LeftOut(id, step);
    held->members.push_back(std::move(member));
  }
}

void Simulation::AddMates(const SequenceStep& step, std::size_t member,
                          haptics::HeldPart* held) const {
  const OccurrenceId id = member == 0 ? step.occurrence : step.members[member - 1];
  const spatial::Pose X_BS = member == 0 ? spatial::Pose() : held->members[member - 1].X_BS;
  for (const product::MateId mate_id : model_->mates_of[id.index()]) {
    const product::Mate& mate = model_->product->mates[mate_id.index()];
    const ModelMate& compiled = model_->mates[mate_id.index()];
    const bool is_a = mate.a.occurrence == id;
    const OccurrenceId other = is_a ? mate.b.occurrence : mate.a.occurrence;
    const bool is_own =
        other == step.occurrence ||
        std::find(step.members.begin(), step.members.end(), other) != step.members.end();
    if (is_own || parts_[other.index()].placement != Placement::kPlaced) {
      continue;
    }
    const mates::MateConstraint constraint =
        mates::MakeConstraint(mate, id, parts_[other.index()].X_WB);
    haptics::HeldMate entry;
    entry.id = mate_id;
    entry.X_WM = constraint.X_WM;
    entry.X_BN = X_BS * constraint.X_BN;
    entry.member = member;
    entry.capture = mates::MakeCaptureMate(mate, id);
    entry.radius = mate.hole_radius;
    const double facing = std::abs((constraint.X_WM.q() * Vec3::UnitZ()).dot(held->insertion_W));
    entry.is_stop = mate.kind == MateKind::kFaceFace && facing > kStopCosine;
    entry.fit = compiled.fit;
    entry.paper_factor = PaperFactorOf(mate);
    entry.body = contact::BodyId(other.index());
    entry.held_faces = is_a ? compiled.faces_a : compiled.faces_b;
    entry.placed_faces = is_a ? compiled.faces_b : compiled.faces_a;
    held->mates.push_back(std::move(entry));
  }
}

OccurrenceId Simulation::FindMissingPartner(const SequenceStep& step) const {
  const auto& steps = model_->sequence.steps;
  const auto is_before = [&](OccurrenceId id) {
    for (const SequenceStep& other : steps) {
      if (other.occurrence == step.occurrence && other.kind == SequenceStep::Kind::kInsert) {
        return false;
      }
      if (other.occurrence == id && other.kind != SequenceStep::Kind::kPark) {
        return true;
      }
    }
    return false;
  };
  const auto is_own = [&step](OccurrenceId id) {
    return id == step.occurrence ||
           std::find(step.members.begin(), step.members.end(), id) != step.members.end();
  };
  OccurrenceId missing;
  for (std::size_t i = 0; i <= step.members.size(); ++i) {
    const OccurrenceId id = i == 0 ? step.occurrence : step.members[i - 1];
    for (const product::MateId mate_id : model_->mates_of[id.index()]) {
      const product::Mate& mate = model_->product->mates[mate_id.index()];
      const OccurrenceId other = mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
      if (is_own(other) || !is_before(other)) {
        continue;
      }
      if (placement(other) == Placement::kPlaced) {
        return {};
      }
      missing = missing.is_valid() ? missing : other;
    }
  }
  return missing;
}

std::shared_ptr<haptics::HeldPart> Simulation::MakeHeldPart(const SequenceStep& step) const {
  const OccurrenceId id = step.occurrence;
  const Body& body = model_->bodies[id.index()];
  const dynamics::MassProperties mass = CombineMass(*model_, step);
  auto held = std::make_shared<haptics::HeldPart>();
  held->occurrence = id;
  held->body = contact::BodyId(id.index());
  held->shape = body.shape;
  held->mass = mass.mass;
  held->p_BoBcm_B = mass.p_BoBcm_B;
  held->I_BBcm_B = mass.I_BBcm_B;
  held->surface = SurfaceOf(model_->product->part_of(id).material);
  held->falls_when_dropped = step.members.empty() && step.kind != SequenceStep::Kind::kPark;
  held->starts_in_place = step.kind == SequenceStep::Kind::kRemove;
  const bool lies_on_table = step.members.empty() && !held->starts_in_place;
  held->X_WB_start = lies_on_table ? ClearOfTable(id) : parts_[id.index()].X_WB;
  held->insertion_W = -step.extraction_W;
  held->left_out = LeftOut(id, step);
  AddMembers(step, held.get());
  if (step.kind == SequenceStep::Kind::kPark) {
    held->X_WB_goal = {body.X_WB_goal.q(), body.X_WB_goal.p() + step.offset_W};
    return held;
  }
  for (std::size_t member = 0; member <= step.members.size(); ++member) {
    AddMates(step, member, held.get());
  }
  held->lacks_partners = held->mates.empty() && FindMissingPartner(step).is_valid();
  if (held->starts_in_place) {
    held->X_WB_goal = held->X_WB_start;
    return held;
  }
  // The place is where the mates say; what they leave free is taken from the drawing (X9).
  std::vector<mates::MateConstraint> constraints;
  for (const haptics::HeldMate& mate : held->mates) {
    constraints.push_back({mate.capture.kind, mate.X_WM, mate.X_BN});
  }
  const spatial::Pose X_before(body.X_WB_goal.q(),
                               body.X_WB_goal.p() - kApproach * held->insertion_W);
  held->X_WB_goal = constraints.empty()
                        ? body.X_WB_goal
                        : mates::ResolveToward(constraints, X_before, body.X_WB_goal).X_WB;
  return held;
}

spatial::Pose Simulation::ClearOfTable(OccurrenceId id) const {
  // Free bodies are hulls with few corners; the exact shape may reach a little below the table.
  constexpr double kGap = 10e-6;  // [m]
  const spatial::Pose& X_WB = parts_[id.index()].X_WB;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : model_->product->part_of(id).mesh.vertices) {
    lowest = std::min(lowest, (X_WB * vertex).z());
  }
  const double lift = std::max(0.0, model_->table_z + kGap - lowest);
  return {X_WB.q(), X_WB.p() + Vec3(0, 0, lift)};
}

}  // namespace hvas::simulation
