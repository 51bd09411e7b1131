#include "person/arm_hand.h"

namespace hvas::person {

void AdvanceArm(const PersonOptions& arm, const HandReference& reference,
                const spatial::Wrench& F_H_W, double dt, spatial::Pose* X_WH,
                spatial::Twist* V_WH) noexcept {
  const Vec3 f = arm.stiffness * (reference.X_WR.p() - X_WH->p()) +
                 arm.damping * (reference.v_R_W - V_WH->v) + F_H_W.f + reference.f_W;
  const Vec3 t = arm.turn_stiffness * spatial::RotationBetween(X_WH->q(), reference.X_WR.q()) -
                 arm.turn_damping * V_WH->w + F_H_W.t;
  V_WH->v += dt / arm.mass * f;
  V_WH->w += dt / arm.inertia * t;
  *X_WH = spatial::Integrate(*X_WH, *V_WH, dt);
}

ArmHand::ArmHand(const PersonOptions& arm, const spatial::Pose& X_WH) : arm_(arm), X_WH_(X_WH) {
  reference_.X_WR = X_WH;
}

device::DeviceState ArmHand::Step(const simulation::OperatorInput& input) noexcept {
  AdvanceArm(arm_, reference_, input.F_H_D, input.dt, &X_WH_, &V_WH_);
  device::DeviceState state;
  state.t_ns = input.t_ns;
  state.X_DH = X_WH_;
  state.V_DH = V_WH_;
  state.is_gripping = reference_.is_gripping;
  return state;
}

}  // namespace hvas::person
