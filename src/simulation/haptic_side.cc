#include "simulation/haptic_side.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "sequence/fit_of_mate.h"
#include "simulation/actual_faces.h"
#include "simulation/load_shedder.h"

namespace hvas::simulation {
namespace {

/** The faces that contact has, by body: as made. By contact alone nothing but the faces answers for
 a fit that leaves no room, and they have its interference. */
std::vector<std::shared_ptr<const contact::FaceOffsets>> MakeContactFaces(
    const Model& model, haptics::Condition condition) {
  if (condition == haptics::Condition::kCollision) {
    ActualFacesInput input = MakeActualFacesInput(model);
    input.fits_answer = false;
    Diagnostics known;  // Those of the faces as made, which the model's own have told of.
    return MakeActualFaces(input, &known);
  }
  std::vector<std::shared_ptr<const contact::FaceOffsets>> faces;
  for (const Body& body : model.bodies) {
    faces.push_back(body.faces);
  }
  return faces;
}

}  // namespace

HapticSide::HapticSide(const Model& model, const std::vector<haptics::TickOptions>& hands,
                       Handover* handover)
    : handover_(*handover) {
  HVAS_DEMAND(!hands.empty() && hands.size() <= haptics::kMaxHands);
  for (const haptics::TickOptions& options : hands) {
    hands_.emplace_back(hands_.size(), options, &scene_);
  }
  const auto faces = MakeContactFaces(model, hands.front().condition);
  for (const Body& body : model.bodies) {
    const contact::BodyId id = scene_.Add(body.shape, body.X_WB_start);
    scene_.SetOffsets(id, faces[id.index()]);
    for (Hand& hand : hands_) {
      hand.tick.SetProperties(
          id, {body.mass.mass, body.mass.p_BoBcm_B, body.mass.I_BBcm_B,
               sequence::SurfaceOf(model.product->part_of(body.occurrence).material)});
      hand.tick.SetLoose(id, body.role == BodyRole::kPart || body.role == BodyRole::kTool);
    }
    scene_.SetEnabled(id, body.role != BodyRole::kPending);
  }
  for (const product::ContactPair& pair : model.product->contact_pairs) {
    const auto find = [&model](product::OccurrenceId id) {
      const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                     [id](const Body& item) { return item.occurrence == id; });
      return contact::BodyId(static_cast<std::size_t>(body - model.bodies.begin()));
    };
    for (Hand& hand : hands_) {
      hand.tick.SetPair({find(pair.a), find(pair.b), pair.compliance, pair.friction});
    }
  }
  scene_.SetGround(model.table_z);
}

void HapticSide::Restore(const std::vector<PartState>& parts,
                         const std::vector<const haptics::RigidGroup*>& together) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const contact::BodyId id(i);
    scene_.SetPose(id, parts[i].X_WB);
    for (Hand& hand : hands_) {
      hand.tick.SetLoose(id, parts[i].placement == Placement::kLoose);
    }
  }
  for (const haptics::RigidGroup* group : together) {
    for (Hand& hand : hands_) {
      hand.tick.Join(*group);
    }
  }
}

void HapticSide::SetEffortLevel(int level) noexcept {
  effort_level_ = level;
  for (Hand& hand : hands_) {
    hand.tick.SetEffort(kEffortLevels[static_cast<std::size_t>(level)]);
  }
}

std::span<const haptics::HandExchange> HapticSide::ListExchanges(const Hand& to) noexcept {
  std::size_t count = 0;
  for (const Hand& hand : hands_) {
    if (hand.index != to.index) {
      exchanges_[count++] = hand.tick.Exchange(to.index);
    }
  }
  return {exchanges_.data(), count};
}

template <typename Do>
void HapticSide::ForOthers(const Hand& hand, Do act) noexcept {
  for (Hand& other : hands_) {
    if (other.index != hand.index) {
      act(&other);
    }
  }
}

void HapticSide::Apply(const TickCommand& command, std::int64_t t_ns) noexcept {
  if (command.kind == TickCommand::Kind::kTake) {
    ApplyTake(command, t_ns);
    return;
  }
  if (command.kind == TickCommand::Kind::kHelp) {
    hands_[command.hand].tick.Help(hands_[command.other].tick.Exchange(command.hand));
    return;
  }
  for (Hand& hand : hands_) {
    hand.tick.SetLoose(command.body, false);
  }
  scene_.SetPose(command.body, command.X_WB);
}

void HapticSide::ApplyTake(const TickCommand& command, std::int64_t t_ns) noexcept {
  Hand& hand = hands_[command.hand];
  hand.tick.Take(command.part, ListExchanges(hand));
  ForOthers(hand, [&command](Hand* other) {
    for (const contact::BodyId body : command.part->bodies) {
      other->tick.SetLoose(body, false);
    }
    if (command.part->left_behind != nullptr) {
      other->tick.Join(*command.part->left_behind);
    }
  });
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
  handover_.PushOwnership(event);
}

void HapticSide::LetGo(Hand* hand, std::int64_t t_ns) noexcept {
  const haptics::HeldPart& part = *hand->tick.held();
  const haptics::LetGo let_go = hand->tick.Drop();
  const haptics::RigidGroup* together =
      let_go.joined != nullptr || !let_go.is_falling ? let_go.joined : part.group.get();
  ForOthers(*hand, [&](Hand* other) {
    if (together != nullptr) {
      other->tick.Join(*together);
    } else if (let_go.is_falling) {
      other->tick.SetLoose(part.body, true);
    }
  });
  hand->metrics.arrival = let_go.arrival.d_W.norm();
  hand->metrics.arrival_angle = let_go.arrival.angle;
  SimulationEvent event;
  event.t_ns = t_ns;
  event.kind = SimulationEvent::Kind::kDropped;
  event.hand = hand->index;
  event.occurrence = part.occurrence;
  event.state = haptics::HoldState::kEmpty;
  event.X_WB = let_go.X_WB;
  event.was_seated = let_go.is_in_place && let_go.joined == nullptr;
  if (let_go.joined != nullptr) {
    event.onto = product::OccurrenceId(let_go.joined->leader().index());
  }
  event.to_place = let_go.to_place;
  event.metrics = hand->metrics;
  handover_.PushOwnership(event);
}

haptics::TickOutput HapticSide::Tick(std::size_t hand, const device::DeviceState& device,
                                     std::int64_t since_write_ns) noexcept {
  TickCommand command;
  while (handover_.commands.TryPop(&command)) {
    if (log_ != nullptr) {
      log_->Add(command);
    }
    Apply(command, device.t_ns);
    ++applied_commands_;
  }
  haptics::TickContext context;
  context.model_age_ns = device.t_ns - handover_.physics_t_ns.load(std::memory_order_acquire);
  context.is_stopped = is_stopped_.load(std::memory_order_acquire);
  context.effort_level = effort_level_;
  context.since_write_ns = since_write_ns;
  haptics::TickOutput out = RunTick(&hands_[hand], device, context);
  if (log_ != nullptr) {
    log_->Add({device, context.model_age_ns, since_write_ns, context.is_stopped,
               static_cast<std::uint8_t>(effort_level_), static_cast<std::uint8_t>(hand), 0,
               out.F_H_D});
  }
  return out;
}

haptics::TickOutput HapticSide::ReplayTick(const TickLog& log, std::size_t i) noexcept {
  const TickLog::Tick& tick = log.tick(i);
  for (; replayed_commands_ < log.command_count() && log.command(replayed_commands_).tick <= i;
       ++replayed_commands_) {
    Apply(log.command(replayed_commands_).command, tick.device.t_ns);
  }
  haptics::TickContext context;
  context.model_age_ns = tick.model_age_ns;
  context.is_stopped = tick.is_stopped;
  context.effort_level = tick.effort_level;
  context.since_write_ns = tick.since_write_ns;
  return ReplayTick(tick.hand, tick.device, context);
}

haptics::TickOutput HapticSide::ReplayTick(std::size_t hand, const device::DeviceState& device,
                                           const haptics::TickContext& context) noexcept {
  SetEffortLevel(context.effort_level);
  return RunTick(&hands_[hand], device, context);
}

haptics::TickOutput HapticSide::RunTick(Hand* hand, const device::DeviceState& device,
                                        const haptics::TickContext& context) noexcept {
  if (hand->tick.held() != nullptr && device.is_valid && !device.is_gripping) {
    LetGo(hand, device.t_ns);
  }
  if (device.is_valid && !device.is_gripping) {
    hand->tick.StopHelping();
  }
  haptics::TickOutput out = hand->tick.Tick(device, context, ListExchanges(*hand));
  UpdateMetrics(hand, device.t_ns, out);
  ReportChanges(hand, device, out);
  HandReport report;
  report.t_ns = device.t_ns;
  report.is_gripping = device.is_gripping && device.is_valid;
  report.out = out;
  for (const haptics::FreeBody& body : hand->tick.awake()) {
    report.moving[report.moving_count++] = {body.id, body.X_WB};
  }
  for (const haptics::TurnedFastener& turned : hand->tick.turned()) {
    const contact::BodyId body = turned.drive->body;
    report.turned[report.turned_count++] = {body, scene_.pose(body)};
  }
  handover_.reports[hand->index].Write(report);
  return out;
}

void HapticSide::ReportChanges(Hand* hand, const device::DeviceState& device,
                               const haptics::TickOutput& out) noexcept {
  SimulationEvent event;
  event.t_ns = device.t_ns;
  event.hand = hand->index;
  event.occurrence = out.occurrence;
  event.state = out.state;
  if (out.state != hand->last_state) {
    SimulationEvent change = event;
    change.X_WB = out.X_WD;
    change.metrics = hand->metrics;
    if (handover_.TryPushTelemetry(change)) {  // else it is reported by the next tick
      hand->last_state = out.state;
    }
  }
  ReportSafety(hand, event, out.gate_actions);
  if (effort_level_ != reported_effort_level_) {
    event.kind = SimulationEvent::Kind::kEffort;
    event.effort_level = effort_level_;
    if (handover_.TryPushTelemetry(event)) {
      reported_effort_level_ = effort_level_;
    }
  }
  if (device.condition != hand->last_condition) {
    event.kind = SimulationEvent::Kind::kDevice;
    event.condition = device.condition;
    event.vendor_code = device.vendor_code;
    if (handover_.TryPushTelemetry(event)) {
      hand->last_condition = device.condition;
    }
  }
}

void HapticSide::ReportSafety(Hand* hand, SimulationEvent event,
                              std::uint32_t gate_actions) noexcept {
  constexpr std::int64_t kQuietNs = 1'000'000'000;  // an action that goes on is one event
  for (std::size_t bit = 0; bit < hand->last_action_ns.size(); ++bit) {
    if ((gate_actions >> bit & 1u) == 0) {
      continue;
    }
    std::int64_t& last_ns = hand->last_action_ns[bit];
    if (last_ns == 0 || event.t_ns - last_ns > kQuietNs) {
      event.gate_actions |= 1u << bit;
    }
    last_ns = event.t_ns;
  }
  if (event.gate_actions == 0) {
    return;
  }
  event.kind = SimulationEvent::Kind::kSafety;
  if (!handover_.TryPushTelemetry(event)) {
    handover_.lost_safety_events.fetch_add(1, std::memory_order_relaxed);
  }
}

void HapticSide::UpdateMetrics(Hand* hand, std::int64_t t_ns,
                               const haptics::TickOutput& out) noexcept {
  if (hand->tick.held() == nullptr) {
    return;
  }
  HoldMetrics& metrics = hand->metrics;
  const Vec3 p_Cm = out.X_WD * hand->tick.held()->p_BoBcm_B;
  metrics.path += (p_Cm - hand->p_last_Cm).norm();
  hand->p_last_Cm = p_Cm;
  metrics.peak_true = std::max(metrics.peak_true, out.F_true_W.f.norm());
  metrics.peak_felt = std::max(metrics.peak_felt, out.F_H_W.f.norm());
  metrics.fit_true = std::max(metrics.fit_true, std::abs(out.axial_true));
  metrics.fit_felt = std::max(metrics.fit_felt, std::abs(out.axial_felt));
  metrics.preload = std::max(metrics.preload, out.preload);
  metrics.tightening = std::max(metrics.tightening, out.tightening);
  metrics.is_thread_crossed = metrics.is_thread_crossed || out.is_thread_crossed;
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

}  // namespace hvas::simulation
