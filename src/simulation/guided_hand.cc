#include "simulation/guided_hand.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::simulation {
namespace {

// Choices, as docs/algorithms/guided_hand.md explains.
constexpr double kCarrySpeed = 0.45;     // [m/s]
constexpr double kFastest = 1.3;         // [m/s]: the peak of the fastest reach
constexpr double kApproachSpeed = 0.15;  // [m/s]
constexpr double kInsertSpeed = 0.04;    // [m/s]
constexpr double kStandOff = 4e-3;       // [m] before anything engages, from where it goes slowly
constexpr double kGraspTime = 0.2;       // [s]
constexpr double kSettleTime = 0.25;     // [s]
constexpr double kReleaseTime = 0.1;     // [s]
constexpr double kPutDownGap = 2e-3;     // [m] above the table
constexpr double kAtReference = 0.2e-3;  // [m]: the hand is there
constexpr double kCalm = 5e-3;           // [m/s]
constexpr double kMostWait = 1.5;        // [s] for a hand to come to its reference
constexpr double kLearnTime = 0.1;       // [s] in which a weight is learned
constexpr double kCorrectTime = 0.15;    // [s] in which an error of the part is corrected
// [s], likewise of how it is turned: large parts swing slowly in the coupling.
constexpr double kTurnCorrectTime = 1.5;
constexpr double kBeside = 0.3e-3;         // [m] beside its way, where a part goes no further
constexpr double kLag = 0.15e-3;           // [m] behind its way, where it presses harder
constexpr double kTurnedBeside = 0.02;     // [rad], likewise
constexpr double kTurnRate = 0.5;          // [rad/s]: it turns no faster on its way
constexpr double kThreadRate = 6;          // [rad/s], along a thread: about a turn a second
constexpr double kMostTwistLead = 0.3;     // [rad], likewise where it tightens a thread
constexpr double kAhead = 0.1e-3;          // [m] along its way, where its direction is taken
constexpr double kOvershoot = 0.15e-3;     // [m] that the arm's mass goes on by where it bends
constexpr double kBraking = 3e-3;          // [m] before a bend, where it slows down
constexpr double kMostTurnLead = 0.1;      // [rad] that the hand turns ahead of the part
constexpr double kPatience = 60;           // [s] for a way, besides four times what it takes
constexpr double kMostOffset = 0.02;       // [m]
constexpr double kMostTurn = 0.2;          // [rad]
constexpr double kSlackTime = 0.08;        // [s]
constexpr double kSpeedTime = 0.02;        // [s] over which the speed is measured
constexpr double kSlowShare = 0.4;         // Of the speed that it wants; slower presses harder.
constexpr double kFastShare = 2;           // Of the speed that it wants; faster, it has given way.
constexpr double kFirstPush = 2;           // [N]
constexpr double kPushRate = 40;           // [N/s]
constexpr double kLeadPerForce = 1.25e-3;  // [m/N]: arm and coupling, one after the other
constexpr double kHangs = 50e-6;           // [m]; nearer, a part hangs where it is meant to be
constexpr double kTurned = 1e-3;           // [rad], likewise
constexpr double kNearer = 0.2e-3;         // [m] that count as coming on
constexpr double kHeldUpTime = 1.5;        // [s]
constexpr double kBackOff = 3e-3;          // [m] that it is drawn back
constexpr int kMostTries = 3;

}  // namespace

Arm GuidedHand::MakeArm() {
  Arm arm;
  arm.stiffness = 1000;
  arm.damping = 40;
  arm.inertia = 0.02;
  arm.turn_stiffness = 60;
  arm.turn_damping = 1.6;
  return arm;
}

GuidedHand::GuidedHand(const spatial::Pose& X_WH)
    : arm_(MakeArm()), X_WH_(X_WH), p_ref_(X_WH.p()), q_ref_(X_WH.q()) {}

std::string GuidedHand::DescribeEffort() const {
  return fmt::format("path-not-followed: held up {:.2f} mm before its place on its planned way",
                     units::ToMm(held_up_at_));
}

void GuidedHand::Begin(Phase phase) noexcept {
  phase_ = phase;
  phase_time_s_ = 0;
}

void GuidedHand::BeginTask(const PersonTask& task) noexcept {
  task_ = task;
  is_held_up_ = false;
  offset_W_.setZero();
  turn_W_.setZero();
  load_W_.setZero();
  tries_ = 0;
  is_backing_ = false;
  reaches_.Start({q_ref_, p_ref_}, task.centre_W);
  reaches_.Add(task.takes_out ? task.X_WG_goal : task.X_WG_start, 1.5 * kCarrySpeed, false);
  Begin(Phase::kReach);
}

void GuidedHand::BeginCarry() noexcept {
  const Quat& q = task_.X_WG_start.q();
  reaches_.Start({q_ref_, p_ref_}, task_.centre_W);
  reaches_.Add({q, task_.CalcLifted()}, kCarrySpeed, false);
  reaches_.Add({q, task_.CalcPointAside(task_.transfer_radius)}, kCarrySpeed, false);
  reaches_.Add(task_.WayAt(task_.CalcWayToSphere(task_.engage_distance + 2 * kStandOff)),
               kCarrySpeed, true);
  Begin(Phase::kCarry);
}

void GuidedHand::BeginFollow() noexcept {
  // Where a part begins within the product, the way begins there; else at its end, or at its goal.
  const double outside = task_.CalcWayToSphere(task_.engage_distance + 2 * kStandOff);
  seen_ = task_.takes_out ? 0 : outside;
  if (task_.starts_on_way) {
    seen_ = task_.TravelOf(task_.X_WG_start, task_.engage_distance);
  }
  travel_ = seen_;
  nearest_ = seen_;
  speed_ = 0;
  since_nearer_s_ = 0;
  push_ = kFirstPush;
  Begin(Phase::kFollow);
}

void GuidedHand::BeginPutDown() noexcept {
  const Quat& q = task_.X_WG_start.q();
  reaches_.Start({q_ref_, p_ref_}, task_.centre_W);
  reaches_.Add({q, task_.CalcPointAside(task_.transfer_radius)}, kCarrySpeed, true);
  reaches_.Add({q, task_.CalcLifted()}, kCarrySpeed, false);
  reaches_.Add({q, task_.X_WG_start.p() + Vec3(0, 0, kPutDownGap)}, kApproachSpeed, false);
  Begin(Phase::kPutDown);
}

bool GuidedHand::FollowReaches() noexcept {
  if (!reaches_.Follow(dt_)) {
    phase_time_s_ = 0;
    p_ref_ = reaches_.X_WR().p();
    q_ref_ = reaches_.X_WR().q();
    return false;
  }
  p_ref_ = reaches_.X_WR().p();
  q_ref_ = reaches_.X_WR().q();
  const bool is_there = (p_ref_ - X_WH_.p()).norm() < kAtReference && V_WH_.v.norm() < kCalm;
  return is_there || phase_time_s_ > kMostWait;
}

void GuidedHand::Correct(const spatial::Twist& error, double most) noexcept {
  offset_W_ += dt_ / kCorrectTime * error.v;
  turn_W_ += dt_ / kTurnCorrectTime * error.w;
  offset_W_ *= std::min(1.0, most / std::max(most, offset_W_.norm()));
  turn_W_ *= std::min(1.0, kMostTurn / std::max(kMostTurn, turn_W_.norm()));
}

void GuidedHand::Refer(const spatial::Pose& X_WG) noexcept {
  p_ref_ = X_WG.p() + offset_W_;
  q_ref_ = spatial::RotationFromVector(turn_W_) * X_WG.q();
}

void GuidedHand::Press(double speed, double wanted_speed) noexcept {
  const bool is_slow = speed < kSlowShare * wanted_speed;
  push_ = is_slow ? std::min(kMostHandForce, push_ + kPushRate * dt_)
                  : std::max(kFirstPush, push_ - 2 * kPushRate * dt_);
  if (speed > kFastShare * wanted_speed) {
    // What gave way runs into what the hand was ahead by, and is not thrown.
    push_ = std::clamp(std::abs(travel_ - seen_) / kLeadPerForce, kFirstPush, kMostHandForce);
  }
}

void GuidedHand::Advance(double wanted_speed) noexcept {
  const double most = push_ * kLeadPerForce;
  const bool is_fast = Sense() * speed_ > kFastShare * wanted_speed;
  const double next = travel_ + (is_fast ? 0 : Sense() * wanted_speed * dt_);
  travel_ = std::clamp(next, seen_ - most, seen_ + most);
}

bool GuidedHand::IsHeldUp() noexcept {
  if (Sense() * (seen_ - nearest_) > kNearer) {
    nearest_ = seen_;
    since_nearer_s_ = 0;
    return false;
  }
  since_nearer_s_ += push_ >= kMostHandForce ? dt_ : 0;
  return since_nearer_s_ > kHeldUpTime;
}

void GuidedHand::TryAgain() noexcept {
  since_nearer_s_ = 0;
  push_ = kFirstPush;
  if (++tries_ < kMostTries) {
    is_backing_ = !is_backing_;
    back_to_ = seen_ + Sense() * kBackOff;
    nearest_ = seen_;
    return;
  }
  GiveUp();
}

void GuidedHand::GiveUp() noexcept {
  is_held_up_ = true;
  held_up_at_ = seen_;
  is_gripping_ = false;
  Begin(Phase::kRelease);
}

bool GuidedHand::IsOnWay(const spatial::Twist& error) noexcept {
  return error.v.norm() < kBeside && error.w.norm() < kTurnedBeside;
}

void GuidedHand::FollowByPose(const spatial::Twist& error, double speed) noexcept {
  if (IsOnWay(error)) {
    seen_ += Sense() * speed * dt_;
  }
  const Vec3 ahead = Sense() * task_.way->RateAt(seen_ + Sense() * kAhead).v;
  const bool lags = error.v.dot(ahead) > kLag * ahead.norm();
  push_ = std::clamp(push_ + (lags ? 1 : -2) * kPushRate * dt_, 0.0, kMostHandForce);
  travel_ = seen_ + Sense() * push_ * kLeadPerForce;
}

void GuidedHand::FollowByForce(const spatial::Twist& error, double speed) noexcept {
  if (IsOnWay(error)) {
    Press(Sense() * speed_, speed);
    Advance(speed);
  } else {
    push_ = kFirstPush;
    travel_ = seen_;  // It comes back onto its way first.
  }
}

double GuidedHand::LimitOnWay(double speed) const noexcept {
  if (task_.way == nullptr) {
    return speed;
  }
  const double turns = task_.way->RateAt(seen_).w.norm();
  const double rate = task_.is_threaded ? kThreadRate : kTurnRate;
  // A mass on a spring that comes at v goes on by v sqrt(m / k) where its reference turns off.
  const double bend = task_.way->CalcSharpestBend(seen_, Sense() * kBraking);
  const double around = kOvershoot * std::sqrt(arm_.stiffness / arm_.mass);
  return std::min(
      {speed, rate / std::max(turns, rate / speed), around / std::max(bend, around / speed)});
}

spatial::Pose GuidedHand::CalcLead() const noexcept {
  if (task_.way == nullptr) {
    return task_.WayAt(travel_);
  }
  // Along the tangent: around a bend, what the hand is ahead by would be beside the way.
  const spatial::Pose X_WN = task_.WayAt(seen_);
  const spatial::Twist rate = task_.way->RateAt(seen_ + Sense() * kAhead);
  Vec3 turn = (travel_ - seen_) * rate.w;
  const double most = task_.is_threaded ? kMostTwistLead : kMostTurnLead;
  turn *= most / std::max(most, turn.norm());
  return {spatial::RotationFromVector(turn) * X_WN.q(), X_WN.p() + (travel_ - seen_) * rate.v};
}

void GuidedHand::StepFollow(const OperatorInput& input) noexcept {
  if (input.hears_seated && !task_.takes_out) {
    Begin(Phase::kSettle);
    return;
  }
  const spatial::Pose X_WG(input.X_WD.q(), input.X_WD * task_.p_BG);
  const double speed =
      LimitOnWay(seen_ > task_.engage_distance + kStandOff ? kApproachSpeed : kInsertSpeed);
  const double before = seen_;
  seen_ = task_.bends() ? seen_ : task_.TravelOf(X_WG, seen_);
  speed_ += ((seen_ - before) / dt_ - speed_) * std::min(1.0, dt_ / kSpeedTime);
  const spatial::Pose X_WN = task_.WayAt(seen_);
  const spatial::Twist error{spatial::RotationBetween(X_WG.q(), X_WN.q()), X_WN.p() - X_WG.p()};
  Correct(error, task_.bends() ? most_ahead_ : kMostOffset);
  if (is_backing_ && Sense() * (seen_ - back_to_) > 0) {
    is_backing_ = false;
    nearest_ = seen_;
    push_ = kFirstPush;
  }
  const double outside = task_.CalcWayToSphere(task_.engage_distance + 2 * kStandOff);
  if (task_.takes_out && seen_ > outside) {
    BeginPutDown();
    return;
  }
  if (task_.bends()) {
    FollowByPose(error, speed);
  } else {
    FollowByForce(error, speed);
  }
  Refer(CalcLead());
  if (phase_time_s_ > kPatience + 4 * outside / kInsertSpeed) {
    GiveUp();
  } else if (IsHeldUp()) {
    TryAgain();
  }
}

void GuidedHand::StepCarry(const OperatorInput& input) noexcept {
  load_W_ += (input.F_H_D.f - load_W_) * (dt_ / kLearnTime);
  (void)FollowReaches();
  const spatial::Pose X_WG(input.X_WD.q(), input.X_WD * task_.p_BG);
  const spatial::Twist error{spatial::RotationBetween(X_WG.q(), q_ref_), p_ref_ - X_WG.p()};
  if (reaches_.is_done()) {
    Correct(error, kMostOffset);
  }
  Refer({q_ref_, p_ref_});
  const bool hangs_there = error.v.norm() < kHangs && error.w.norm() < kTurned;
  if (reaches_.is_done() && (hangs_there || phase_time_s_ > kMostWait)) {
    BeginFollow();
  }
}

void GuidedHand::StepPhase(const OperatorInput& input) noexcept {
  switch (phase_) {
    case Phase::kIdle: {
      PersonTask task;
      if (tasks_.TryPop(&task)) {
        BeginTask(task);
      }
      break;
    }
    case Phase::kReach:
      if (FollowReaches()) {
        is_gripping_ = true;
        Begin(Phase::kGrasp);
      }
      break;
    case Phase::kGrasp:
      if (phase_time_s_ <= kGraspTime) {
        break;
      }
      if (task_.takes_out || task_.starts_on_way) {
        BeginFollow();
      } else {
        BeginCarry();
      }
      break;
    case Phase::kCarry:
      StepCarry(input);
      break;
    case Phase::kFollow:
      StepFollow(input);
      break;
    case Phase::kSettle:
      p_ref_ += (X_WH_.p() - p_ref_) * (dt_ / kSlackTime);
      if (phase_time_s_ > kSettleTime) {
        is_gripping_ = false;
        Begin(Phase::kRelease);
      }
      break;
    case Phase::kPutDown:
      if (FollowReaches()) {
        is_gripping_ = false;
        Begin(Phase::kRelease);
      }
      break;
    case Phase::kRelease:
      load_W_ *= 1 - dt_ / kLearnTime;
      if (phase_time_s_ > kReleaseTime) {
        load_W_.setZero();
        Begin(Phase::kIdle);
        finished_count_.fetch_add(1, std::memory_order_release);
      }
      break;
  }
}

device::DeviceState GuidedHand::Step(const OperatorInput& input) noexcept {
  dt_ = input.dt;
  phase_time_s_ += dt_;
  const Vec3 p_before = p_ref_;
  StepPhase(input);
  // The arm presses no harder than it may.
  if (const Vec3 ahead = p_ref_ - X_WH_.p(); ahead.norm() > most_ahead_) {
    p_ref_ = X_WH_.p() + most_ahead_ * ahead.normalized();
  }
  v_ref_ = (p_ref_ - p_before) / dt_;
  v_ref_ *= kFastest / std::max(kFastest, v_ref_.norm());
  HandReference reference;
  reference.X_WR = {q_ref_, p_ref_};
  reference.v_R_W = v_ref_;
  reference.f_W = -load_W_;
  AdvanceArm(arm_, reference, input.F_H_D, dt_, &X_WH_, &V_WH_);
  device::DeviceState state;
  state.t_ns = input.t_ns;
  state.X_DH = X_WH_;
  state.V_DH = V_WH_;
  state.is_gripping = is_gripping_;
  return state;
}

}  // namespace hvas::simulation
