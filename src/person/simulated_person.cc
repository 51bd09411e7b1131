#include "person/simulated_person.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "person/person_habits.h"
#include "simulation/arm.h"

namespace hvas::person {
namespace {

// Where each number comes from: docs/algorithms/simulated_person.md, "Where its numbers come from".
constexpr double kGraspTime = 0.35;       // [s]
constexpr double kHandSettleTime = 0.25;  // [s]; the hand rests when it has heard the part seat
constexpr double kRestTime = 1.0;         // [s] without pressing, before it draws the part out
constexpr double kSlackTime = 0.08;       // [s] in which the arm goes slack
constexpr double kReleaseTime = 0.2;      // [s]
constexpr double kPutDownGap = 2e-3;      // [m] above the table, where a part is let go
constexpr double kLearnTime = 0.3;        // [s] in which a weight is learned
constexpr double kSwings = 5e-3;          // [m] from its hand; no weight stretches it further
constexpr double kSeenBeside = 1e-3;      // [m] beside the hand, where a part is seen to hang so
constexpr double kCorrectTime = 0.15;     // [s] in which the hand corrects that
constexpr double kAtHand = 0.002;         // [m]; close enough to take something up
constexpr double kFollows = 0.5e-3;       // [m]; a part that meets nothing is as near to its hand
constexpr double kCalm = 0.02;            // [m/s]; slow enough for it
constexpr double kMostLag = 0.05;         // [m]; the mind does not run ahead of the hand
constexpr double kMostTurnLag = 0.3;      // [rad]
constexpr double kTurned = 0.05;          // [rad]; as good as turned
constexpr double kTurning = 0.02;         // [rad/s]; slower than that, the hand does not turn
constexpr double kCalmTime = 0.2;         // [s]; what swings is only still for a moment
constexpr double kMostWait = 1.5;         // [s] for a hand to come, and what it holds to hang still
constexpr double kSenseTime = 0.08;       // [s] in which it notices how fast its hand is

}  // namespace

const char* ToString(PersonKind kind) noexcept {
  switch (kind) {
    case PersonKind::kCareful:
      return "careful";
    case PersonKind::kHasty:
      return "hasty";
    case PersonKind::kStiff:
      return "stiff";
  }
  return "?";
}

PersonOptions MakeHabits(PersonKind kind, PersonOptions careful) noexcept {
  if (kind == PersonKind::kHasty) {
    constexpr double kFaster = 3;  // A choice.
    careful.insert_speed *= kFaster;
    careful.first_push = careful.push_limit;
    careful.careful_push = careful.push_limit;
    careful.light_push = careful.push_limit;
  }
  careful.gives_way = kind == PersonKind::kCareful;
  return careful;
}

SimulatedPerson::SimulatedPerson(const PersonOptions& options, std::uint64_t seed,
                                 const spatial::Pose& X_WH)
    : options_(options), random_(seed), X_WH_(X_WH), p_ref_(X_WH.p()), q_ref_(X_WH.q()) {
  for (double& phase : tremor_phase_) {
    phase = random_.Uniform(0, 2 * std::numbers::pi);
  }
}

std::string SimulatedPerson::DescribeEffort() const {
  return fmt::format("gave up after {} searches", searches());
}

void SimulatedPerson::Begin(const simulation::PersonTask& task) noexcept {
  task_ = task;
  gave_up_ = false;
  search_count_ = 0;
  is_guided_ = false;
  is_gripping_ = false;
  for (int k = 0; k < 3; ++k) {
    aim_offset_[k] = options_.aim_error * random_.Normal();
    aim_turn_[k] = options_.aim_error_angle * random_.Normal();
  }
  const spatial::Pose& X_WG = task.takes_out ? task.X_WG_goal : task.X_WG_start;
  StartReaches(Phase::kReach);
  reaches_.Add({X_WG.q(), X_WG.p()}, 1.5 * options_.carry_speed, false);
}

void SimulatedPerson::StartReaches(Phase phase) noexcept {
  BeginPhase(phase);
  reaches_.Start({q_ref_, p_ref_}, task_.centre_W);
  waited_s_ = 0;
  calm_s_ = 0;
  swinging_s_ = 0;
}

bool SimulatedPerson::FollowReaches() noexcept {
  if (reaches_.is_done()) {
    return true;
  }
  if ((p_ref_ - X_WH_.p()).norm() > kMostLag || IsTurning(kMostTurnLag)) {
    return false;  // waits for the hand, which a device may hold up
  }
  const bool is_done = reaches_.Follow(dt_);
  p_ref_ = reaches_.X_WR().p();
  q_ref_ = reaches_.X_WR().q();
  return is_done;
}

bool SimulatedPerson::IsTurning(double lag) const noexcept {
  return is_at_device_ && spatial::RotationBetween(X_WH_.q(), q_ref_).norm() > lag &&
         V_H_.w.norm() > kTurning;
}

bool SimulatedPerson::HasCome(const simulation::OperatorInput& input) noexcept {
  waited_s_ += dt_;
  if (is_at_device_) {
    const bool is_calm = V_H_.v.norm() < kCalm && v_part_W_.norm() < kCalm && !IsTurning(kTurned);
    calm_s_ = is_calm ? calm_s_ + dt_ : 0;
    return calm_s_ > kCalmTime || waited_s_ > kMostWait;
  }
  // What hangs at its hand needs no wait, but what swings does.
  const bool is_swinging = input.sees_part && (p_part_W_ - X_WH_.p()).norm() > kSwings;
  swinging_s_ = is_swinging ? kCalmTime : std::max(0.0, swinging_s_ - dt_);
  return swinging_s_ <= 0 || waited_s_ > kMostWait;
}

double SimulatedPerson::TravelOf(const spatial::Pose& X_WG) const noexcept {
  return task_.TravelOf(X_WG, travel_);
}

double SimulatedPerson::SeenTravel(const simulation::OperatorInput& input) const noexcept {
  return TravelOf({input.X_WD.q(), input.X_WD * task_.p_BG});
}

Vec3 SimulatedPerson::OutwardOfWay() const noexcept {
  return task_.OutwardAt(travel_);
}

double SimulatedPerson::CalcOutwardSpeed(const simulation::OperatorInput& input) const noexcept {
  return task_.way != nullptr ? task_.way->CalcSpeed({V_H_.w, MotionOf(input)}, travel_)
                              : MotionOf(input).dot(task_.extraction_W);
}

double SimulatedPerson::CalcWayToSphere() const noexcept {
  return task_.CalcWayToSphere(task_.engage_distance + 2 * kStandOff);
}

void SimulatedPerson::PlanCarry() noexcept {
  StartReaches(Phase::kCarry);
  reaches_.Add({task_.X_WG_start.q(), task_.CalcLifted()}, options_.carry_speed, false);
  reaches_.Add({task_.X_WG_start.q(), task_.CalcPointAside(task_.transfer_radius)},
               options_.carry_speed, false);
  const spatial::Pose X_WG = task_.WayAt(CalcWayToSphere());
  reaches_.Add({X_WG.q(), X_WG.p()}, options_.carry_speed, true);
}

void SimulatedPerson::PlanPutDown() noexcept {
  const Vec3& d = task_.extraction_W;
  const double way = std::max(0.0, CalcWayToSphere() - TravelOf({q_ref_, p_ref_}));
  const Quat& q = task_.X_WG_start.q();
  StartReaches(Phase::kPutDown);
  reaches_.Add({q_ref_, p_ref_ + way * d}, options_.carry_speed, false);
  reaches_.Add({q, task_.CalcPointAside(task_.transfer_radius)}, options_.carry_speed, true);
  reaches_.Add({q, task_.CalcLifted()}, options_.carry_speed, false);
  reaches_.Add({q, task_.X_WG_start.p() + Vec3(0, 0, kPutDownGap)}, options_.approach_speed, false);
}

void SimulatedPerson::PlanReturn() noexcept {
  const Vec3 d = task_.extraction_W;
  const double way = task_.engage_distance + kStandOff + 2 * task_.transfer_radius;
  const Quat q = q_ref_;
  gave_up_ = true;
  StartReaches(Phase::kGiveUp);
  reaches_.Add({q, p_ref_ + way * d}, options_.carry_speed, false);
  reaches_.Add({q, task_.CalcPointAside(way)}, options_.carry_speed, true);
  reaches_.Add({task_.X_WG_start.q(), task_.CalcLifted()}, options_.carry_speed, false);
  reaches_.Add({task_.X_WG_start.q(), task_.X_WG_start.p() + Vec3(0, 0, kPutDownGap)},
               options_.approach_speed, false);
}

Vec3 SimulatedPerson::Tremor() noexcept {
  Vec3 tremor;
  constexpr double kFrequencies[3] = {8.3, 9.7, 11.4};  // [Hz]: 8 to 12, and no multiples.
  for (int k = 0; k < 3; ++k) {
    tremor[k] = options_.tremor *
                std::sin(2 * std::numbers::pi * kFrequencies[k] * t_s_ + tremor_phase_[k]);
  }
  return tremor;
}

void SimulatedPerson::LearnLoad(const spatial::Wrench& F_H_W) noexcept {
  // At a device also on the way in: its border pulls where the simulated one has none.
  // What the part meets there is no load: it stretches from the hand.
  const bool is_on_its_way =
      phase_ == Phase::kApproach || (phase_ == Phase::kInsert && !is_guided_);
  const bool is_free =
      is_at_device_ && is_on_its_way && (p_part_W_ - X_WH_.p() - grip_offset_W_).norm() < kFollows;
  const bool is_carrying =
      phase_ == Phase::kCarry || phase_ == Phase::kGrasp || phase_ == Phase::kPutDown;
  // What lies in its place does not hang in the hand before it is lifted: where it does not come,
  // what pulls down is taken for its weight.
  const bool is_lifting =
      phase_ == Phase::kWithdraw && task_.takes_out && stuck_time_s_ > kStuckBeforeSearch;
  // What it took for the weight before was not: here nothing touches the part.
  const bool is_hanging =
      phase_ == Phase::kInsert && is_outside_ && (is_backing_off_ || look_time_s_ > 0);
  if (is_carrying || is_free || is_hanging) {
    carried_force_ += (F_H_W.f - carried_force_) * (dt_ / kLearnTime);
  } else if (is_lifting) {
    const Vec3 down(0, 0, std::min(0.0, F_H_W.f.z()));
    carried_force_ += (down - carried_force_) * (dt_ / kLearnTime);
  } else if (!is_gripping_) {
    carried_force_ -= carried_force_ * (dt_ / 0.05);
  }
}

void SimulatedPerson::MoveHand(const spatial::Wrench& F_H_W) noexcept {
  LearnLoad(F_H_W);
  simulation::HandReference reference;
  reference.X_WR = spatial::Pose(q_ref_, p_ref_ + Tremor());
  reference.v_R_W = v_ref_;
  reference.f_W = -carried_force_;
  simulation::AdvanceArm(options_, reference, F_H_W, dt_, &X_WH_, &V_H_);
}

void SimulatedPerson::BeginApproach(const simulation::OperatorInput& input) noexcept {
  const Vec3& d = task_.extraction_W;
  grip_offset_W_ = input.X_WD * task_.p_BG - X_WH_.p();  // as it is held, unloaded
  // At a device the hand closes where the border lets it: it aims with what it holds.
  hold_offset_W_ = is_at_device_ ? Vec3(grip_offset_W_.dot(d) * d - grip_offset_W_) : Vec3::Zero();
  travel_ = task_.engage_distance + kStandOff;
  StartReaches(Phase::kApproach);
  reaches_.Add(
      {spatial::RotationFromVector(aim_turn_) * task_.WayAt(travel_).q(), CalcApproachEnd()},
      options_.approach_speed, false);
}

Vec3 SimulatedPerson::CalcApproachEnd() const noexcept {
  return task_.WayAt(task_.engage_distance + kStandOff).p() + hold_offset_W_ + aim_offset_;
}

void SimulatedPerson::CorrectHold(const simulation::OperatorInput& input) noexcept {
  // At a device it aims with what it holds from the beginning.
  if (is_at_device_ || !input.sees_part) {
    return;
  }
  const Vec3& d = task_.extraction_W;
  const Vec3 hanging = p_part_W_ - X_WH_.p();
  const Vec3 beside = hanging - hanging.dot(d) * d;
  const bool is_seen = beside.norm() > kSeenBeside || hold_offset_W_ != Vec3::Zero();
  if (is_seen && beside.norm() < kSwings) {
    hold_offset_W_ -= dt_ / kCorrectTime * (hold_offset_W_ + beside);
    reaches_.Redirect(CalcApproachEnd());
  }
}

void SimulatedPerson::Decide(const simulation::OperatorInput& input) noexcept {
  Watch(input);
  dt_ = input.dt;
  t_s_ += dt_;
  phase_time_s_ += dt_;
  is_guided_ = is_guided_ || input.hears_capture;
  const Vec3 p_ref_before = p_ref_;
  StepPhase(input);
  v_ref_ = (p_ref_ - p_ref_before) / dt_;
}

void SimulatedPerson::StepPhase(const simulation::OperatorInput& input) noexcept {
  switch (phase_) {
    case Phase::kDone: {
      simulation::PersonTask task;
      if (tasks_.TryPop(&task)) {
        Begin(task);
      }
      break;
    }
    case Phase::kReach:
      StepReach();
      break;
    case Phase::kGrasp:
      StepGrasp(input);
      break;
    case Phase::kCarry:
      if (FollowReaches() && HasCome(input)) {
        BeginApproach(input);
      }
      break;
    case Phase::kApproach:
      StepApproach(input);
      break;
    case Phase::kInsert:
      StepInsert(input);
      break;
    case Phase::kRest:
      Slacken();
      if (phase_time_s_ > kRestTime) {
        BeginWithdraw(TravelOf({q_ref_, p_ref_}), 0);
      }
      break;
    case Phase::kWithdraw:
      StepWithdraw(input);
      break;
    case Phase::kSettle:
      Slacken();
      if (phase_time_s_ > kHandSettleTime) {
        BeginRelease();
      }
      break;
    case Phase::kRelease:
      if (phase_time_s_ > kReleaseTime) {
        phase_ = Phase::kDone;
        finished_count_.fetch_add(1, std::memory_order_release);
      }
      break;
    case Phase::kPutDown:
    case Phase::kGiveUp:
      if (FollowReaches()) {
        BeginRelease();
      }
      break;
  }
}

void SimulatedPerson::StepReach() noexcept {
  if (FollowReaches() && phase_time_s_ > reaches_.first_duration() + 0.3 &&
      (p_ref_ - X_WH_.p()).norm() < kAtHand && V_H_.v.norm() < kCalm && !IsTurning(kTurned)) {
    BeginPhase(Phase::kGrasp);
    is_gripping_ = true;
  }
}

void SimulatedPerson::StepGrasp(const simulation::OperatorInput& input) noexcept {
  if (phase_time_s_ <= kGraspTime) {
    return;
  }
  if (task_.takes_out) {
    BeginWithdraw(0, options_.first_push);
  } else if (task_.starts_on_way) {
    BeginOnWay(input);
  } else {
    PlanCarry();
  }
}

void SimulatedPerson::StepApproach(const simulation::OperatorInput& input) noexcept {
  if (input.hears_seated) {
    BeginPhase(Phase::kSettle);
  } else if (FollowReaches() && HasCome(input)) {
    BeginInsert();
  } else {
    CorrectHold(input);
  }
}

void SimulatedPerson::BeginPhase(Phase phase) noexcept {
  phase_ = phase;
  phase_time_s_ = 0;
}

void SimulatedPerson::BeginRelease() noexcept {
  BeginPhase(Phase::kRelease);
  is_gripping_ = false;
}

void SimulatedPerson::Slacken() noexcept {
  p_ref_ += (X_WH_.p() - p_ref_) * (dt_ / kSlackTime);
}

void SimulatedPerson::Watch(const simulation::OperatorInput& input) noexcept {
  const Vec3 p_part = input.X_WD * task_.p_BG;
  v_part_W_ += ((p_part - p_part_W_) / input.dt - v_part_W_) * std::min(1.0, input.dt / kSenseTime);
  p_part_W_ = p_part;
}

simulation::HandReference SimulatedPerson::Intend(const simulation::OperatorInput& input) noexcept {
  const double share = std::min(1.0, input.dt / kSenseTime);
  V_H_.v += ((input.X_WH.p() - X_WH_.p()) / input.dt - V_H_.v) * share;
  V_H_.w += (spatial::RotationBetween(X_WH_.q(), input.X_WH.q()) / input.dt - V_H_.w) * share;
  X_WH_ = input.X_WH;
  is_at_device_ = true;
  Decide(input);
  const Quat& q_WD = input.workspace.X_WD.q();
  LearnLoad({q_WD * input.F_H_D.t, q_WD * input.F_H_D.f});
  simulation::HandReference reference;
  reference.X_WR = {q_ref_, p_ref_ + Tremor()};
  reference.v_R_W = v_ref_;
  reference.f_W = -carried_force_;
  reference.is_gripping = is_gripping_;
  return reference;
}

device::DeviceState SimulatedPerson::Step(const simulation::OperatorInput& input) noexcept {
  Decide(input);
  MoveHand(input.F_H_D);
  device::DeviceState state;
  state.t_ns = input.t_ns;
  state.X_DH = X_WH_;
  state.V_DH = V_H_;
  state.is_gripping = is_gripping_;
  return state;
}

}  // namespace hvas::person
