#include "person/arm_hand.h"

namespace hvas::person {

ArmHand::ArmHand(const simulation::Arm& arm, const spatial::Pose& X_WH) : arm_(arm), X_WH_(X_WH) {
  reference_.X_WR = X_WH;
}

device::DeviceState ArmHand::Step(const simulation::OperatorInput& input) noexcept {
  simulation::AdvanceArm(arm_, reference_, input.F_H_D, input.dt, &X_WH_, &V_WH_);
  device::DeviceState state;
  state.t_ns = input.t_ns;
  state.X_DH = X_WH_;
  state.V_DH = V_WH_;
  state.is_gripping = reference_.is_gripping;
  return state;
}

}  // namespace hvas::person
