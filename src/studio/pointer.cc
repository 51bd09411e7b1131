#include "studio/pointer.h"

#include <algorithm>

namespace hvas::studio {
namespace {

constexpr double kTimeConstant = 0.012;  // [s]; time constant of each stage: smooths 60 Hz input
// [m/s]: below the 1 m/s of a displayed part. A choice.
constexpr double kMaxSpeed = 0.8;
// [rad/s]: below the 10 rad/s of a displayed part. A choice.
constexpr double kMaxTurn = 6;

Vec3 Limit(const Vec3& v, double most) noexcept {
  const double norm = v.norm();
  return norm > most ? Vec3(v * (most / norm)) : v;
}

/** One step of a first-order lag, in position and orientation. */
spatial::Twist Approach(const spatial::Pose& goal, double dt, spatial::Pose* X) noexcept {
  const double rate = 1 / std::max(dt, kTimeConstant);
  const spatial::Twist V{Limit(rate * spatial::RotationBetween(X->q(), goal.q()), kMaxTurn),
                         Limit(rate * (goal.p() - X->p()), kMaxSpeed)};
  const Vec3 turn = dt * V.w;
  *X = {(spatial::RotationFromVector(turn) * X->q()).normalized(), X->p() + dt * V.v};
  return V;
}

}  // namespace

PointerOperator::PointerOperator(const spatial::Pose& X_WH, const Clock& clock)
    : clock_(clock), inputs_(PointerInput{0, X_WH, false}), X_WH_(X_WH), X_WS_(X_WH) {}

void PointerOperator::Follow(const spatial::Pose& X_WH, double dt) noexcept {
  (void)Approach(X_WH, dt, &X_WS_);
  V_H_ = Approach(X_WS_, dt, &X_WH_);
}

const PointerInput& PointerOperator::ReadInput(bool sees_part, std::int64_t* age_ns) noexcept {
  inputs_.Update();
  const PointerInput& wanted = inputs_.value();
  // The timeout matters only while a part is held.
  *age_ns =
      sees_part && wanted.t_ns > 0 ? std::max<std::int64_t>(0, clock_.NowNs() - wanted.t_ns) : 0;
  return wanted;
}

person::HandReference PointerOperator::Intend(const simulation::OperatorInput& input) noexcept {
  constexpr double kReached = 5e-3;  // [m]: near enough to close on a part. A choice.
  person::HandReference reference;
  const PointerInput& wanted = ReadInput(input.sees_part, &reference.client_age_ns);
  Follow(reference.client_age_ns < kInputTimeoutNs ? wanted.X_WH : X_WH_, input.dt);
  reference.X_WR = X_WH_;
  reference.v_R_W = V_H_.v;
  // The device has to bring the hand there before it can close on a part.
  const bool is_there = (input.X_WH.p() - wanted.X_WH.p()).norm() < kReached;
  reference.is_gripping = wanted.is_gripping && (input.sees_part || is_there);
  return reference;
}

device::DeviceState PointerOperator::Step(const simulation::OperatorInput& input) noexcept {
  device::DeviceState state;
  const PointerInput& wanted = ReadInput(input.sees_part, &state.client_age_ns);
  state.is_gripping = wanted.is_gripping;
  if (!input.sees_part) {
    // An empty hand jumps to its target: it holds no part that would be dragged along.
    X_WH_ = wanted.X_WH;
    X_WS_ = wanted.X_WH;
    V_H_ = {};
  } else if (state.client_age_ns < kInputTimeoutNs) {
    Follow(wanted.X_WH, input.dt);
  } else {
    // The input has timed out: the part stays where it is.
    Follow(X_WH_, input.dt);
  }
  state.X_DH = haptics::MapPoseToDevice(input.workspace, X_WH_);
  const Quat q_DW = input.workspace.X_WD.q().conjugate();
  state.V_DH = {q_DW * V_H_.w, q_DW * V_H_.v / input.workspace.scale};
  return state;
}

}  // namespace hvas::studio
