// How the simulated person brings a part in, and draws one out: by feeling, looking, searching,
// pressing and giving way (docs/algorithms/simulated_person.md).

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "person/person_habits.h"
#include "person/simulated_person.h"

namespace hvas::person {
namespace {

// Where each number comes from: docs/algorithms/simulated_person.md, "Where its numbers come from".
constexpr double kSlowShare = 0.4;    // of the speed of insertion; slower than that presses harder
constexpr double kStillSpeed = 1e-3;  // [m/s] that counts as not moving
constexpr double kBackOff = 8e-3;     // [m] before trying elsewhere
constexpr double kLoosen = 1.5e-3;    // [m] back when it sticks in its hole
constexpr double kLeadIn = 1e-3;      // [m] of travel until it is inside
constexpr double kLookTime = 0.4;     // [s]
constexpr double kCarefulSpeed = 0.012;    // [m/s]; what hits the hole tilted, wedges in it
constexpr double kStuckBeforeSlack = 0.5;  // [s] until it pushes and turns by turns
constexpr double kRockingRate = 3;         // [Hz]
constexpr double kTwistingRate = 0.8;      // [Hz]
constexpr double kFollowTime =
    0.3;  // [s] in which the eye corrects where the part is beside its way
constexpr double kFollowReach = 1e-3;    // [m], by no more than this
constexpr double kFollowTurn = 0.1;      // [rad]
constexpr double kMostTwistLag = 0.01;   // [rad] of the hand behind its intent
constexpr double kRocking = 0.02;        // [rad]; harder the longer it sticks
constexpr double kMostRocking = 0.12;    // [rad]
constexpr double kRockingTime = 6;       // [s]
constexpr double kRockingTurn = 0.12;    // of a turn about the way in, for each of rocking
constexpr double kRockingLag = 0.02;     // [s]
constexpr double kLeastTouch = 0.2;      // [N] that is felt as touch
constexpr double kTouchOfLoad = 0.25;    // Share of what the hand carries, the same
constexpr double kYieldTime = 0.3;       // [s]; the wrist gives way to what it feels
constexpr double kYieldReach = 2e-3;     // [m], no further than this
constexpr double kErrorsOfEye = 3;       // Standard deviations of what it sees
constexpr double kYieldTurn = 0.05;      // [rad]
constexpr double kSearchPitch = 0.5e-3;  // [m] of radius a try
constexpr double kEyePitch = 0.25;       // Of the error of a close look, the same by eye
constexpr double kLeadOnWay = 1e-3;    // [m] that the hand goes before the part on a way that bends
constexpr double kTwist = 0.1;         // [rad] that the hand turns a screw ahead of where it is
constexpr double kYieldToHole = 6e-3;  // [m] at most to a hole that has the part on its axis
constexpr double kLeastAside = 0.1;    // [N] across the way that is felt, in a careful hand
constexpr double kLeastTwist = 4e-3;   // [N m], the same
constexpr double kGivesWayFirst = 2;   // [s] until what sticks in a hole with play is rocked, too
constexpr double kNearer = 0.05e-3;    // [m] of travel that count as coming on
constexpr double kNotNearer = 2;       // [s] until whoever sees the way tries anew
constexpr double kLeadWhenStuck = 2e-3;  // [m/s] more of it while the part is stuck

void LimitLength(double most, Vec3* v) {
  *v *= std::min(1.0, most / std::max(v->norm(), most));
}

}  // namespace

Vec3 SimulatedPerson::OffsetBesideWay() const noexcept {
  return hold_offset_W_ + aim_offset_ + search_offset_ + yield_offset_ + follow_offset_;
}

Quat SimulatedPerson::TurnBesideWay() const noexcept {
  return spatial::RotationFromVector(aim_turn_ + yield_turn_ + follow_turn_ + rocking_);
}

double SimulatedPerson::HandTravel() const noexcept {
  // Around a corner what the hand aims beside its way would be travel.
  return task_.way != nullptr
             ? TravelOf({TurnBesideWay().conjugate() * X_WH_.q(), X_WH_.p() - OffsetBesideWay()})
             : TravelOf(X_WH_);
}

bool SimulatedPerson::EndInsertion(const simulation::OperatorInput& input,
                                   const Insertion& insertion) noexcept {
  if (input.hears_seated) {
    BeginPhase(Phase::kSettle);
    return true;
  }
  if (input.sees_part && insertion.seen_travel <= task_.turn_back) {
    BeginPhase(Phase::kRest);
    return true;
  }
  if (phase_time_s_ <= CalcPatience()) {
    return false;
  }
  if (task_.starts_on_way) {
    LeaveThere();
  } else if (task_.way != nullptr) {
    BeginWithdraw(insertion.hand_travel, options_.first_push);  // It has to turn its way out again.
  } else {
    PlanReturn();
  }
  return true;
}

void SimulatedPerson::ChooseSenses(const simulation::OperatorInput& input,
                                   Insertion* insertion) const noexcept {
  // Where no mate guides it and it has missed once, it looks, lays the part on with a light touch,
  // and gives way inside.
  const bool has_more_to_meet = task_.is_guided_by_planes || task_.way != nullptr;
  insertion->is_by_eye = input.sees_part && (!is_guided_ || has_more_to_meet);
  // What would wedge in its hole is pressed lightly, too.
  insertion->is_by_touch = is_guided_ && task_.has_play;
  insertion->is_led_by_hole = insertion->is_by_touch && options_.gives_way;
  insertion->is_careful =
      (insertion->is_by_eye && (search_count_ > 0 || HasSlotToFind())) || insertion->is_led_by_hole;
  const bool is_watched = insertion->is_by_eye || (is_at_device_ && input.sees_part);
  insertion->travel = is_watched ? insertion->seen_travel : insertion->hand_travel;
  insertion->is_inside = (insertion->is_by_eye || insertion->is_by_touch) &&
                         insertion->travel < task_.engage_distance - kLeadIn;
}

void SimulatedPerson::BackOff(const Insertion& insertion) noexcept {
  nearest_travel_ = std::numeric_limits<double>::infinity();
  since_nearer_s_ = 0;
  travel_ += options_.insert_speed * dt_;
  is_backing_off_ =
      insertion.travel < back_off_to_ && insertion.hand_travel < back_off_to_ + 3 * kBackOff;
  look_time_s_ = kLookTime;
  stuck_time_s_ = 0;
  push_ = options_.first_push;
}

bool SimulatedPerson::AdvanceTravel(const simulation::OperatorInput& input,
                                    const Insertion& insertion, const Advance& advance) noexcept {
  // The mate has it on the axis: the hand comes there, too, before it goes in.
  const bool is_waiting =
      insertion.is_led_by_hole && !insertion.is_inside && FeelsAside(input, insertion.d);
  // The arm's spring turns the lead into a force.
  travel_ = std::max(travel_ - (is_waiting ? 0 : advance.wanted_speed * dt_),
                     insertion.hand_travel - advance.lead);
  // The device may give way where the part does not: the eye tells.
  const double stretch =
      insertion.seen_travel - insertion.hand_travel - grip_offset_W_.dot(insertion.d);
  const bool is_left_behind = input.sees_part && stretch > options_.most_stretch;
  travel_ = is_left_behind
                ? std::max(travel_, insertion.hand_travel + stretch - options_.most_stretch)
                : travel_;
  // It follows a hand that is pushed back, but not one that leaves.
  travel_ = std::min(travel_, task_.engage_distance + kStandOff + 3 * kBackOff);
  since_nearer_s_ = task_.way == nullptr || IsNearer(insertion.travel) ? 0 : since_nearer_s_ + dt_;
  const bool is_coming = HasSlotToFind() ? since_nearer_s_ == 0 : advance.speed >= kStillSpeed;
  return !is_waiting &&
         (is_left_behind || (!is_coming && (insertion.is_careful || IsPressing(input))));
}

void SimulatedPerson::PressOn(const simulation::OperatorInput& input,
                              const Insertion& insertion) noexcept {
  Advance advance;
  advance.speed = -CalcOutwardSpeed(input);
  advance.wanted_speed = insertion.is_careful ? kCarefulSpeed : options_.insert_speed;
  const bool is_slow = advance.speed < kSlowShare * advance.wanted_speed;
  const bool is_careful_inside = insertion.is_careful && insertion.is_inside;
  AdjustPush(CalcAddedForce(input), advance.speed, advance.wanted_speed,
             insertion.is_careful && !insertion.is_inside);
  push_ = insertion.is_careful ? std::min(push_, options_.careful_push) : push_;
  if (task_.way != nullptr && insertion.is_by_eye && insertion.travel < task_.engage_distance) {
    FollowWayByEye(input, insertion.d);
  }
  advance.lead = LeadOf(input);  // Before the hand yields, which changes it.
  if (insertion.is_led_by_hole) {
    YieldToHole(input, insertion.d);
  }
  const bool is_stuck = AdvanceTravel(input, insertion, advance);
  stuck_time_s_ = is_stuck ? stuck_time_s_ + dt_ : std::max(0.0, stuck_time_s_ - dt_);
  if (input.sees_part && insertion.seen_travel < -kStandOff) {
    // Beyond its place, where nothing stops it: it was missed.
    StartSearch(insertion.d, insertion.travel, false);
    back_off_to_ = task_.engage_distance + kStandOff;
    return;
  }
  const double most_stuck = is_careful_inside && !IsLedByEye() ? kRockingTime : kStuckBeforeSearch;
  if (since_nearer_s_ > (is_guided_ ? kRockingTime : kNotNearer) || stuck_time_s_ > most_stuck) {
    StartSearch(insertion.d, insertion.travel, insertion.is_by_eye);
    return;
  }
  if (!is_careful_inside) {
    return;
  }
  if (!insertion.is_led_by_hole && (task_.way == nullptr || is_slow) && FeelsTouch(input)) {
    YieldToTouch(
        insertion.d);  // On a way that turns, what comes behind the hand meets nothing yet.
  }
  if (!insertion.is_by_touch || stuck_time_s_ > kGivesWayFirst) {
    Rock(insertion.d, is_slow);
  }
}

void SimulatedPerson::StepInsert(const simulation::OperatorInput& input) noexcept {
  Insertion insertion;
  insertion.d = OutwardOfWay();
  insertion.hand_travel = HandTravel();
  insertion.seen_travel = SeenTravel(input);
  if (EndInsertion(input, insertion)) {
    return;
  }
  ChooseSenses(input, &insertion);
  const bool may_look =
      (insertion.is_careful || task_.way != nullptr) && insertion.is_by_eye && look_time_s_ > 0;
  if (is_backing_off_) {
    BackOff(insertion);
  } else if (may_look) {
    look_time_s_ -= dt_;
    if (look_time_s_ <= 0) {
      LookClosely(input);
    }
  } else {
    PressOn(input, insertion);
  }
  const spatial::Pose X_WG = task_.WayAt(travel_);
  p_ref_ = X_WG.p() + OffsetBesideWay();
  q_ref_ = HasSlackWrist() ? X_WH_.q() : TurnBesideWay() * X_WG.q();
}

bool SimulatedPerson::HasSlackWrist() const noexcept {
  constexpr double kHalf = 0.5;  // Of the time it pushes, as long as it turns: a choice.
  return HasSlotToFind() && stuck_time_s_ > kStuckBeforeSlack &&
         std::fmod(kTwistingRate * stuck_time_s_, 1) < kHalf;
}

const Vec3& SimulatedPerson::MotionOf(const simulation::OperatorInput& input) const noexcept {
  // A device, or a soft coupling, lets the hand come on while the part stands: the eye tells.
  return input.sees_part && (is_at_device_ || !is_guided_) ? v_part_W_ : V_H_.v;
}

bool SimulatedPerson::IsNearer(double travel) noexcept {
  // What rocks and twists moves to and fro.
  if (travel > nearest_travel_ - kNearer) {
    return false;
  }
  nearest_travel_ = travel;
  return true;
}

double SimulatedPerson::CalcPatience() const noexcept {
  // A long way in takes its time.
  const double slowest = task_.way != nullptr ? kCarefulSpeed : options_.insert_speed;
  return std::max(options_.patience_s, 3 * task_.engage_distance / slowest);
}

double SimulatedPerson::PushLimit() const noexcept {
  return is_guided_ ? options_.push_limit : options_.unguided_limit;
}

bool SimulatedPerson::IsPressing(const simulation::OperatorInput& input) const noexcept {
  constexpr double kNearly = 0.9;  // Share of the limit that is as good as all of it: a choice.
  return is_at_device_ ? push_ >= PushLimit() || CalcAddedForce(input) >= kNearly * PushLimit()
                       : push_ > options_.first_push;
}

double SimulatedPerson::CalcAddedForce(const simulation::OperatorInput& input) const noexcept {
  return (input.workspace.X_WD.q() * input.F_H_D.f - carried_force_).norm();
}

void SimulatedPerson::AdjustPush(double resistance, double speed, double wanted_speed,
                                 bool is_light) noexcept {
  const bool is_slow = speed < kSlowShare * wanted_speed;
  const bool is_at_limit = resistance >= PushLimit();
  const double change =
      is_slow && !is_at_limit && !is_light ? options_.push_rate : -options_.push_rate;
  push_ = std::max(is_light ? options_.light_push : options_.first_push, push_ + change * dt_);
}

void SimulatedPerson::BeginWithdraw(double travel, double push) noexcept {
  BeginPhase(Phase::kWithdraw);
  push_ = push;
  travel_ = travel;
  stuck_time_s_ = 0;
}

void SimulatedPerson::StepWithdraw(const simulation::OperatorInput& input) noexcept {
  const double hand_travel = TravelOf(X_WH_);
  const bool is_out = hand_travel > task_.engage_distance + 2 * kStandOff;
  const bool is_too_long = phase_time_s_ > CalcPatience();
  if (task_.takes_out && is_out) {
    PlanPutDown();
    return;
  }
  if (task_.takes_out && is_too_long) {
    LeaveThere();
    return;
  }
  if (is_out || is_too_long) {
    PlanReturn();
    return;
  }
  const double speed = CalcOutwardSpeed(input);
  stuck_time_s_ = speed < kStillSpeed ? stuck_time_s_ + dt_ : 0;
  AdjustPush(input.F_H_D.f.norm(), speed, options_.insert_speed, false);
  travel_ = std::min(travel_ + options_.insert_speed * dt_, hand_travel + LeadOf(input));
  if (task_.way != nullptr) {
    const spatial::Pose X_WG = task_.WayAt(travel_);
    p_ref_ = X_WG.p();
    q_ref_ = X_WG.q();
    return;
  }
  const Vec3& d = task_.extraction_W;
  const Vec3 along = p_ref_ - task_.X_WG_goal.p();
  p_ref_ += (travel_ - along.dot(d)) * d;
}

bool SimulatedPerson::FeelsTouch(const simulation::OperatorInput& input) const noexcept {
  return CalcAddedForce(input) > std::max(kLeastTouch, kTouchOfLoad * carried_force_.norm());
}

void SimulatedPerson::YieldToHole(const simulation::OperatorInput& input, const Vec3& d) noexcept {
  // By the force alone, until there is none: a load that was learned wrong bends the arm as well.
  const Quat& q_WD = input.workspace.X_WD.q();
  const Vec3 aside = q_WD * input.F_H_D.f / options_.stiffness;
  const Vec3 turned = q_WD * input.F_H_D.t / options_.turn_stiffness;
  yield_offset_ += dt_ / kYieldTime * (aside - aside.dot(d) * d);
  yield_turn_ += dt_ / kYieldTime * (turned - turned.dot(d) * d);
  LimitLength(kYieldToHole, &yield_offset_);
  LimitLength(kYieldTurn, &yield_turn_);
}

bool SimulatedPerson::FeelsAside(const simulation::OperatorInput& input,
                                 const Vec3& d) const noexcept {
  const Quat& q_WD = input.workspace.X_WD.q();
  const Vec3 f = q_WD * input.F_H_D.f;
  const Vec3 t = q_WD * input.F_H_D.t;
  return (f - f.dot(d) * d).norm() > kLeastAside || (t - t.dot(d) * d).norm() > kLeastTwist;
}

void SimulatedPerson::YieldToTouch(const Vec3& d) noexcept {
  // As with a compliant support of the part: the walls of the hole, not the hand's belief, say
  // where the axis is.
  if (!options_.gives_way) {
    return;
  }
  const Vec3 held_back = X_WH_.p() - p_ref_;
  yield_offset_ += dt_ / kYieldTime * (held_back - held_back.dot(d) * d);
  Vec3 turned_back = spatial::RotationBetween(q_ref_, X_WH_.q());
  if (HasSlotToFind()) {
    turned_back -= turned_back.dot(d) * d;  // The eye says how far it has to turn in its hole.
  }
  yield_turn_ += dt_ / kYieldTime * turned_back;
  // Whoever sees the way gives way no further than it may have seen wrong.
  LimitLength(IsLedByEye() ? kErrorsOfEye * options_.eye_error : kYieldReach, &yield_offset_);
  LimitLength(kYieldTurn, &yield_turn_);
}

bool SimulatedPerson::IsLedByEye() const noexcept {
  return !is_guided_ && task_.way != nullptr;
}

bool SimulatedPerson::HasSlotToFind() const noexcept {
  return is_guided_ && task_.bends();
}

void SimulatedPerson::FollowWayByEye(const simulation::OperatorInput& input,
                                     const Vec3& d) noexcept {
  const double travel = SeenTravel(input);
  const spatial::Pose X_WG = task_.WayAt(travel);
  Vec3 aside = input.X_WD * task_.p_BG - X_WG.p() + seen_error_ - yield_offset_;
  Vec3 turned = spatial::RotationBetween(X_WG.q(), input.X_WD.q()) + seen_turn_error_ - rocking_ -
                yield_turn_;
  const spatial::Twist rate = task_.way->RateAt(travel);
  const double ahead = task_.way->CalcSpeed({turned, aside}, travel);  // Its push sees to that.
  aside -= ahead * rate.v;
  turned -= ahead * rate.w;
  if (is_guided_) {  // The mate keeps it upright.
    turned = turned.dot(d) * d;
  }
  follow_offset_ -= dt_ / kFollowTime * aside;
  follow_turn_ -= dt_ / kFollowTime * turned;
  LimitLength(kFollowReach, &follow_offset_);
  LimitLength(kFollowTurn, &follow_turn_);
}

void SimulatedPerson::Rock(const Vec3& d, bool is_slow) noexcept {
  // A part that wedges, tilted, comes free where it stands upright: to and fro, and slowly round.
  const bool is_twisting = HasSlotToFind();
  const double rate = is_twisting ? kTwistingRate : kRockingRate;
  rocking_angle_ += is_slow ? dt_ * 2 * std::numbers::pi * rate : 0;
  const double strength = std::min(kMostRocking, kRocking * (1 + 2 * stuck_time_s_));
  const double tilt = is_slow ? strength * std::sin(rocking_angle_) : 0;
  const double round = kRockingTurn * rocking_angle_;
  // In its hole it is upright: what has to find a slot there is twisted.
  const Vec3 axis = is_twisting ? Vec3::UnitZ() : Vec3(std::cos(round), std::sin(round), 0);
  Vec3 wanted = tilt * (spatial::FrameFromZ(d) * axis);
  if (IsLedByEye()) {  // About the axis of the way it would go to and fro on it.
    const Vec3 about = task_.way->RateAt(travel_).w.stableNormalized();
    wanted -= wanted.dot(about) * about;
  }
  const Vec3 step = dt_ / kRockingLag * (wanted - rocking_);
  // A light touch: what the part meets on its way round holds the hand up.
  const Vec3 lag = spatial::RotationBetween(X_WH_.q(), q_ref_);
  const bool is_held_up = is_twisting && lag.dot(step) > 0 && lag.norm() > kMostTwistLag;
  if (!is_held_up) {
    rocking_ += step;
  }
}

void SimulatedPerson::LookClosely(const simulation::OperatorInput& input) noexcept {
  const Vec3 d = OutwardOfWay();
  const double seen_travel = SeenTravel(input);
  // Where nothing is engaged yet the part is where the hand wants it, but for what it errs by.
  const bool is_free = IsLedByEye() && seen_travel > task_.engage_distance;
  const spatial::Pose X_WG =
      task_.way == nullptr ? task_.X_WG_goal : task_.WayAt(is_free ? travel_ : seen_travel);
  Vec3 aside = input.X_WD * task_.p_BG - X_WG.p() - search_offset_;
  // How far it is on its way, and how it hangs at the hand, it feels.
  aside -= (is_free ? grip_offset_W_ : aside).dot(d) * d;
  const Vec3 turned = spatial::RotationBetween(X_WG.q(), input.X_WD.q());
  if (task_.way != nullptr && !is_free) {
    aim_offset_ -= aim_offset_.dot(d) * d;
  }
  follow_offset_.setZero();
  follow_turn_.setZero();
  // It knows the mean of all its looks.
  const double of_mean = 1 / std::sqrt(static_cast<double>(std::max(1, search_count_.load())));
  for (int k = 0; k < 3; ++k) {
    seen_error_[k] = of_mean * options_.eye_error * random_.Normal();
    aim_offset_[k] -= aside[k] + seen_error_[k];
    seen_turn_error_[k] = of_mean * options_.eye_error_angle * random_.Normal();
    aim_turn_[k] -= turned[k] + seen_turn_error_[k];
  }
}

void SimulatedPerson::StartSearch(const Vec3& d, double travel, bool is_by_eye) noexcept {
  const bool is_first = ++search_count_ == 1;
  is_outside_ = travel > task_.engage_distance + kStandOff;
  if (is_outside_) {
    grip_offset_W_ = p_part_W_ - X_WH_.p();  // It hung otherwise when the approach began.
  }
  is_backing_off_ = true;
  rocking_.setZero();
  // What touch has taught becomes belief.
  aim_offset_ += yield_offset_;
  aim_turn_ += yield_turn_;
  yield_offset_.setZero();
  yield_turn_.setZero();
  follow_offset_.setZero();
  follow_turn_.setZero();
  const bool has_way = task_.way != nullptr;
  if (is_by_eye && (!is_first || has_way) && travel < task_.engage_distance - kBackOff) {
    // It sticks in the hole: a little back, and straighter; on a way that turns each time further.
    back_off_to_ = travel + kLoosen * (has_way ? search_count_.load() : 1);
    return;
  }
  // Missed: back off and try beside, on a spiral of golden angles.
  back_off_to_ = travel + kBackOff;
  if (is_by_eye) {
    back_off_to_ = std::max(back_off_to_, task_.engage_distance + kStandOff);
  }
  // What a mate has on its axis only has to come in straighter, as far as the hand can tell.
  const bool is_on_axis = is_guided_ && task_.has_play && options_.gives_way;
  for (int k = 0; k < 3; ++k) {
    aim_turn_[k] =
        (is_on_axis ? options_.eye_error_angle : options_.aim_error_angle) * random_.Normal();
  }
  if (is_on_axis) {
    search_offset_.setZero();
    return;
  }
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  // Whoever looks tries where it saw the place, no further beside it than it may have seen wrong.
  const double pitch = is_by_eye ? kEyePitch * options_.eye_error : kSearchPitch;
  const int beside = search_count_.load() - (is_by_eye ? 1 : 0);
  const double radius = pitch * std::sqrt(static_cast<double>(beside));
  const double angle = golden * search_count_ + random_.Uniform(0, 0.5);
  search_offset_ =
      spatial::FrameFromZ(d) * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0);
}

double SimulatedPerson::LeadOf(const simulation::OperatorInput& input) const noexcept {
  // The arm is as stiff as it is where the hand really is.
  if (task_.way == nullptr) {
    return input.workspace.scale * push_ / options_.stiffness;
  }
  // Where the way turns, the wrist is what is stiff. Around a corner the hand does not pull before
  // the part is there, unless it is stuck.
  const spatial::Twist rate = task_.way->RateAt(travel_);
  if (task_.is_threaded && rate.w.norm() > rate.v.norm() / kTwist) {
    // What its own arm takes to turn is no twist.
    return kTwist / rate.w.norm() +
           options_.turn_damping / options_.turn_stiffness * options_.insert_speed;
  }
  const double moving = rate.v.squaredNorm();
  const double turning = rate.w.squaredNorm();
  const double stiffness = options_.stiffness * moving + options_.turn_stiffness * turning;
  // What its own arm takes to go on is no push.
  const double drag = kCarefulSpeed * (options_.damping * moving + options_.turn_damping * turning);
  return std::min((input.workspace.scale * push_ + drag) / stiffness,
                  kLeadOnWay + kLeadWhenStuck * stuck_time_s_);
}

void SimulatedPerson::LeaveThere() noexcept {
  gave_up_ = true;
  BeginPhase(Phase::kSettle);
}

void SimulatedPerson::BeginOnWay(const simulation::OperatorInput& input) noexcept {
  grip_offset_W_ = input.X_WD * task_.p_BG - X_WH_.p();
  hold_offset_W_.setZero();
  BeginInsert();
  travel_ = task_.engage_distance;
}

void SimulatedPerson::BeginInsert() noexcept {
  BeginPhase(Phase::kInsert);
  push_ = options_.first_push;
  stuck_time_s_ = 0;
  search_offset_.setZero();
  yield_offset_.setZero();
  yield_turn_.setZero();
  follow_offset_.setZero();
  follow_turn_.setZero();
  rocking_.setZero();
  nearest_travel_ = std::numeric_limits<double>::infinity();
  since_nearer_s_ = 0;
  look_time_s_ = task_.way != nullptr ? kLookTime : 0;  // Where it has to turn, it looks first.
  is_backing_off_ = false;
  is_outside_ = false;
}

}  // namespace hvas::person
