#include "haptics/haptic_tick.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace hvas::haptics {
namespace {

// [s]: fades the weight in (haptics.md, section 3). A choice.
constexpr double kSoftStartTime = 0.3;
constexpr double kMinVirtualMass = 0.05;  // [kg]; lighter parts are felt as this inertia

/** Rotational inertia for a virtual mass: the part's own shape, never thinner than a small ball. */
Mat3 CalcVirtualInertia(const HeldPart& part, double virtual_mass) noexcept {
  const double scale = part.mass > 0 ? virtual_mass / part.mass : 0.0;
  constexpr double kBallRadius = 0.02;  // [m]: the ball's of haptics.md, section 2. A choice.
  return scale * part.I_BBcm_B + 0.4 * virtual_mass * kBallRadius * kBallRadius * Mat3::Identity();
}

double CalcVirtualMass(const HeldPart& part, const TickOptions& options) noexcept {
  return std::clamp(part.mass, kMinVirtualMass, options.max_virtual_mass);
}

/** Without contact, or without the forces of fits, guidance holds a shaft in its hole as well. */
TickOptions WithGuidance(TickOptions options) noexcept {
  options.guidance.contact_in_holes = options.guidance.contact_in_holes && options.renders_fits &&
                                      options.condition != Condition::kConstraint;
  return options;
}

}  // namespace

HapticTick::HapticTick(const TickOptions& options, contact::Scene* scene, std::size_t hand) noexcept
    : options_(WithGuidance(options)),
      scene_(*scene),
      workspace_(options.workspace),
      force_map_(MakeForceMap(options.device)),
      coupling_(options_),
      guidance_(options_),
      contacts_(options_, scene, &guidance_.mates(), hand),
      seating_(options_, &guidance_, &contacts_),
      output_(options_) {}

void HapticTick::Take(const HeldPart* part, std::span<const HandExchange> others) noexcept {
  HVAS_ASSERT(part->bodies.size() == 1 + part->members.size());
  const FreeBody* falling = contacts_.FindAwake(part->body);
  for (auto other = others.begin(); falling == nullptr && other != others.end(); ++other) {
    const auto found = std::find_if(other->awake.begin(), other->awake.end(),
                                    [part](const FreeBody& body) { return body.id == part->body; });
    falling = found != other->awake.end() ? &*found : nullptr;
  }
  StopHelping();
  displayed_.part = part;
  taken_ = part;
  displayed_.X_WD = falling != nullptr ? falling->X_WB : part->X_WB_start;
  displayed_.V = {};
  displayed_.reach = ContactStep::CalcReach(*part);
  ++hold_;
  has_engaged_ = true;
  CreditWeight();
  state_ = HoldState::kFree;
  soft_start_ = 0;
  coupling_.Begin();
  guidance_.Begin(*part);
  seating_.Begin(*part);
  for (const contact::BodyId body : part->bodies) {
    SetLoose(body, false);  // what it lay on or beside is free to move
  }
  if (part->left_behind != nullptr) {
    contacts_.LetGo(*part->left_behind, scene_.pose(part->left_behind->leader()), {});
  }
  const auto begins_there = [](const auto& place) { return place->starts_in_place; };
  const auto& places = part->table_places;
  if (const auto first = std::find_if(places.begin(), places.end(), begins_there);
      first != places.end()) {
    GoTo(**first);
  }
  response_ = {};
}

// Until a mate has caught the part, it is for the place that it is nearest to.
void HapticTick::ChoosePlace(std::span<const HandExchange> others) noexcept {
  const HeldPart* now = displayed_.part;
  if (taken_->table_places.empty()) {
    return;
  }
  const bool is_there =
      now->target == nullptr || contacts_.IsAtRestAt(*now->target, now->X_WT_target, others);
  const bool is_bound = state_ == HoldState::kSeated || seating_.leaves_place() ||
                        guidance_.mates().captured_count() > 0;
  if (is_there && is_bound) {
    return;
  }
  const Vec3 p_WCm = displayed_.p_WCm();
  const auto distance_to = [&](const HeldPart& place) {
    return (place.X_WB_goal * place.p_BoBcm_B - p_WCm).norm();
  };
  const HeldPart* nearest = taken_;
  double least =
      taken_->mates.empty() ? taken_->table_places.front()->target_range : distance_to(*taken_);
  for (const std::shared_ptr<const HeldPart>& place : taken_->table_places) {
    constexpr double kStay = 0.8;  // Share of the distance to the present place: a choice.
    const double distance = (place.get() == now ? kStay : 1.0) * distance_to(*place);
    if (distance < std::min(least, place->target_range) &&
        contacts_.IsAtRestAt(*place->target, place->X_WT_target, others)) {
      nearest = place.get();
      least = distance;
    }
  }
  if (nearest != now) {
    GoTo(*nearest);
  }
}

void HapticTick::GoTo(const HeldPart& place) noexcept {
  if (const HeldPart& before = *displayed_.part; before.target != nullptr) {
    contacts_.LetLoose(*before.target, before.starts_in_place);
  }
  displayed_.part = &place;
  if (place.target != nullptr) {
    contacts_.HoldStill(*place.target);
  }
  guidance_.Begin(place);
  seating_.Begin(place);
  state_ = HoldState::kFree;
}

LetGo HapticTick::Drop() noexcept {
  const HeldPart& part = *displayed_.part;
  LetGo drop;
  const bool has_arrived = is_in_place();
  drop.is_in_place = has_arrived || seating_.CanFinish(displayed_, coupling_.tracked());
  if (drop.is_in_place) {
    drop.arrival = has_arrived ? seating_.arrival() : Seating::CalcRemainder(displayed_);
  }
  drop.X_WB = drop.is_in_place ? part.X_WB_goal : displayed_.X_WD;
  drop.to_place = drop.is_in_place ? 0 : Seating::CalcRemainder(displayed_).d_W.norm();
  drop.is_falling = part.falls_when_dropped && !drop.is_in_place && !guidance_.is_stuck();
  contacts_.MoveInScene(part, drop.X_WB);
  if (drop.is_falling && part.group != nullptr) {
    contacts_.LetGo(*part.group, drop.X_WB, displayed_.V);
  } else if (drop.is_falling) {
    contacts_.LetGo(part.body, drop.X_WB, displayed_.V);
  }
  if (part.target != nullptr && drop.is_in_place) {
    drop.joined = part.joined.get();
    contacts_.LetGo(*drop.joined, scene_.pose(drop.joined->leader()), {});
  } else if (part.target != nullptr && !guidance_.is_stuck()) {
    contacts_.LetLoose(*part.target, part.starts_in_place);
  }
  displayed_.part = nullptr;
  taken_ = nullptr;
  seating_.End();
  state_ = HoldState::kEmpty;
  return drop;
}

void HapticTick::Help(const HandExchange& other) noexcept {
  helped_hand_ = other.hand;
  helped_hold_ = other.is_holding() ? other.hold : 0;
  has_engaged_ = true;
  coupling_.Begin();
}

const DisplayedPart* HapticTick::FindHelped(std::span<const HandExchange> others) const noexcept {
  const auto found = std::find_if(others.begin(), others.end(), [this](const HandExchange& other) {
    return other.hand == helped_hand_ && other.is_holding() && other.hold == helped_hold_;
  });
  return is_helping() && found != others.end() ? &found->displayed : nullptr;
}

void HapticTick::HoldAlong(const DisplayedPart& displayed, TickOutput* out) noexcept {
  out->X_WT = coupling_.Track(hand_, displayed).X_WT;
  out->F_felt_W = coupling_.CalcWrench(displayed);
  out->F_true_W = out->F_felt_W;
  FeelAtHand(*displayed.part, out);
  pulls_along_ = true;
}

void HapticTick::FeelAtHand(const HeldPart& part, TickOutput* out) const noexcept {
  out->F_H_W = out->F_felt_W;
  out->F_H_W.t += (out->X_WT * part.p_BoBcm_B - hand_.X_WH.p()).cross(out->F_felt_W.f);
}

HandExchange HapticTick::Exchange(std::size_t to) const noexcept {
  HandExchange exchange;
  exchange.displayed = displayed_;
  exchange.held_still = displayed_.part != nullptr ? displayed_.part->target.get() : nullptr;
  exchange.hold = hold_;
  exchange.response = response_;
  contacts_.FillExchange(to, &exchange);
  if (pulls_along_ && is_helping() && to == helped_hand_) {
    exchange.coupling = &coupling_;
    exchange.coupled_hold = helped_hold_;
  }
  return exchange;
}

DeviceOutput::Input HapticTick::MakeOutputInput(const spatial::Wrench& F_H_W, bool is_usable,
                                                const DisplayedPart* helped) noexcept {
  DeviceOutput::Input input;
  input.F_H_W = F_H_W;
  input.is_usable = is_usable;
  input.has_engaged = std::exchange(has_engaged_, false);
  if (displayed_.part != nullptr) {
    input.stored = CalcStoredEnergy();
    input.stored_turning = coupling_.CalcTurningEnergy(displayed_);
  } else if (helped != nullptr) {
    input.stored = coupling_.CalcEnergy(*helped) / options_.workspace.mapping.scale;
    input.stored_turning = coupling_.CalcTurningEnergy(*helped);
  }
  return input;
}

TickOutput HapticTick::Tick(const device::DeviceState& state, const TickContext& context,
                            std::span<const HandExchange> others) noexcept {
  TickOutput out;
  out.context = context;
  const bool is_usable = state.is_valid && spatial::IsFinite(state.X_DH) &&
                         state.V_DH.v.allFinite() && state.V_DH.w.allFinite();
  if (is_usable) {
    hand_ = workspace_.Update(state, options_.dt);
  } else {
    workspace_.Lose();
  }
  if (displayed_.part != nullptr) {
    ChoosePlace(others);
  }
  const HeldPart* part = displayed_.part;
  const DisplayedPart* helped = FindHelped(others);
  helped_hold_ = helped != nullptr ? helped_hold_ : 0;
  contacts_.Begin(part, others);
  response_ = {};
  pulls_along_ = false;
  out.X_WH = hand_.X_WH;
  out.X_WT = hand_.X_WH;
  out.X_WD = hand_.X_WH;
  if (part != nullptr && is_usable) {
    out.X_WT = coupling_.Track(hand_, displayed_).X_WT;
    Hold(others, &out);
    FeelAtHand(*part, &out);
  } else {
    if (helped != nullptr && is_usable) {
      HoldAlong(*helped, &out);
    }
    contacts_.StepFreeBodies(&solver_);
  }
  if (part != nullptr) {
    out.occurrence = part->occurrence;
    out.X_WD = displayed_.X_WD;
    if (!others.empty()) {
      contacts_.MoveInScene(*part, displayed_.X_WD);
    }
  } else if (helped != nullptr) {
    out.occurrence = helped->part->occurrence;
    out.X_WD = helped->X_WD;
  }
  static_cast<ContactAccount&>(out) = contacts_.End();
  out.state = helped != nullptr ? HoldState::kFree : state_;
  out.workspace = workspace_.mapping();
  out.F_H_D =
      output_.Pass(state, context, workspace_, MakeOutputInput(out.F_H_W, is_usable, helped));
  out.F_H_W = {out.workspace.X_WD.q() * out.F_H_D.t, out.workspace.X_WD.q() * out.F_H_D.f};
  out.energy = output_.passivity().force().account();
  out.turning_energy = output_.passivity().torque().account();
  out.gate_actions = output_.gate_actions();
  return out;
}

double HapticTick::CalcFeltWeight(const HeldPart& part) const noexcept {
  // Of the device's force: the rest is what the hand lifts, moves and presses with. A choice; a
  // part of 44 kg is felt so with the usual device, and what is heavier hangs in a hoist.
  constexpr double kMostWeight = 0.5;
  return std::min(force_map_.Felt(part.mass * options_.gravity_W.norm()),
                  kMostWeight * options_.device.max_force);
}

void HapticTick::CreditWeight() noexcept {
  // What the hand is owed on the part's way to its place: weight that goes down with it.
  const HeldPart& part = *displayed_.part;
  const double drop = part.X_WB_start.p().z() - part.X_WB_goal.p().z();
  const double weight = CalcFeltWeight(part);
  output_.AddCredit(weight * std::max(0.0, drop) / options_.workspace.mapping.scale);
}

// As if the coupling were never saturated: what counts as stored is never forgotten, so too much
// here only makes the controller remember longer.
double HapticTick::CalcStoredEnergy() const noexcept {
  const HeldPart& part = *displayed_.part;
  const double virtual_mass = CalcVirtualMass(part, options_);
  const double height =
      (displayed_.X_WD.p() - part.X_WB_start.p()).dot(-options_.gravity_W.normalized());
  const double energy = coupling_.CalcEnergy(displayed_) +
                        0.5 * virtual_mass * displayed_.V.v.squaredNorm() +
                        weight_felt_ * std::max(0.0, height);
  return energy / options_.workspace.mapping.scale;
}

void HapticTick::Hold(std::span<const HandExchange> others, TickOutput* out) noexcept {
  soft_start_ = std::min(1.0, soft_start_ + options_.dt / kSoftStartTime);
  if (state_ != HoldState::kSeated) {
    Step(others, out);
    return;
  }
  seating_.Advance(&displayed_);
  if (!seating_.is_finished() && options_.condition != Condition::kConstraint) {
    contacts_.MeasureDepth(displayed_);
  }
  response_.V = displayed_.V;
  out->F_felt_W = coupling_.CalcWrench(displayed_);
  out->F_true_W = out->F_felt_W;
  contacts_.StepFreeBodies(&solver_);
}

void HapticTick::Step(std::span<const HandExchange> others, TickOutput* out) noexcept {
  const HeldPart& part = *displayed_.part;
  guidance_.Update(displayed_, coupling_.tracked().X_WT);
  const double virtual_mass = CalcVirtualMass(part, options_);
  const Mat3 R_WB = displayed_.X_WD.R();
  const Mat3 I_W = R_WB * CalcVirtualInertia(part, virtual_mass) * R_WB.transpose();
  const spatial::Twist V_before = displayed_.V;
  solver_.Begin(virtual_mass, I_W, displayed_.p_WCm(), displayed_.V, options_.dt);
  coupling_.AddTo(displayed_, &solver_);
  for (const HandExchange& other : others) {
    if (other.coupling != nullptr && other.coupled_hold == hold_) {
      other.coupling->AddTo(displayed_, &solver_);
    }
  }
  const Vec3 down_W = options_.gravity_W.normalized();
  const double weight_true = part.mass * options_.gravity_W.norm();
  weight_felt_ = soft_start_ * CalcFeltWeight(part);
  solver_.AddWrench({Vec3::Zero(), weight_felt_ * down_W});
  solver_.AddWrench(contacts_.CalcPush(hold_));
  const EnergyCredit credit = guidance_.AddTo(displayed_, weight_true, soft_start_, &solver_);
  output_.AddCredit(credit.force);
  output_.AddTurningCredit(credit.torque);
  seating_.AddHoming(displayed_, &solver_);
  contacts_.AddBodies(&solver_);
  contacts_.AddHeldContacts(displayed_, &solver_);
  contacts_.AddFreeContacts(&solver_);
  const spatial::Twist V =
      solver_.Solve(contacts_.effort().iterations, guidance_.mates().has_bores());
  contacts_.Finish(solver_);
  contacts_.MoveDisplayed(V, &displayed_);
  if (!others.empty()) {
    RecordResponse(I_W, virtual_mass, V_before);
  }
  out->F_felt_W = coupling_.CalcWrench(displayed_);
  out->F_true_W = out->F_felt_W;
  out->F_true_W.f += (weight_true * soft_start_ - weight_felt_) * down_W;
  guidance_.Finish(solver_, out);
  out->axis = guidance_.DescribeAxis(part);
  UpdateState();
  out->is_matched = seating_.is_matched() || state_ == HoldState::kSeated;
  has_engaged_ = guidance_.HasCapturedMore() || has_engaged_;
}

void HapticTick::RecordResponse(const Mat3& I_W, double mass,
                                const spatial::Twist& V_before) noexcept {
  const spatial::Twist& V = displayed_.V;
  response_ = {true, V, Vec6::Zero(), solver_.matrix(), solver_.inverse()};
  Vec6 gain;
  gain << I_W * (V.w - V_before.w), mass * (V.v - V_before.v);
  // What springs and pushes gave goes on; what contacts and fits bear, they will bear again, and
  // what they stopped is stopped.
  const Vec6 borne = solver_.row_impulse();
  const double given = (gain - borne).tail<3>().norm();
  if (given > 0) {
    response_.gain = std::max(0.0, 1 - borne.tail<3>().norm() / given) * gain;
  }
}

void HapticTick::CreditWayHome(const Seating::Remainder& way) noexcept {
  const double to_go = way.d_W.norm();
  output_.AddCredit(0.5 * options_.coupling.k_lin * to_go * to_go /
                    options_.workspace.mapping.scale);
}

void HapticTick::UpdateState() noexcept {
  const MateGuide& mates = guidance_.mates();
  const bool was_matched = seating_.is_matched();
  const bool has_arrived = seating_.HasArrived(displayed_, coupling_.tracked());
  if (!has_arrived && !was_matched && seating_.IsDrawingHome(*displayed_.part)) {
    CreditWayHome(Seating::CalcRemainder(displayed_));
  }
  if (has_arrived) {
    state_ = HoldState::kSeated;
    seating_.Start(displayed_);
    CreditWayHome(seating_.arrival());
  } else if (mates.captured_count() > 0) {
    state_ = mates.is_aligned() ? HoldState::kMating : HoldState::kCaptured;
  } else {
    state_ = mates.is_near() ? HoldState::kNear : HoldState::kFree;
  }
}

}  // namespace hvas::haptics
