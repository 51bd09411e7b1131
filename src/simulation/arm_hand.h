#pragma once

#include "simulation/arm.h"
#include "simulation/operator.h"

namespace hvas::simulation {

/** A hand that a program leads: the impedance of an arm draws it to the reference that was set
 last, and what it meets pushes it back. Without stiffness it follows the force alone. */
class ArmHand final : public Operator {
 public:
  ArmHand(const Arm& arm, const spatial::Pose& X_WH);

  /** Sets where the hand is to be from the next sample on. On the thread of the ticks. */
  void Lead(const HandReference& reference) noexcept { reference_ = reference; }

  device::DeviceState Step(const OperatorInput& input) noexcept override;

  [[nodiscard]] const spatial::Pose& X_WH() const noexcept { return X_WH_; }

 private:
  Arm arm_;
  HandReference reference_;
  spatial::Pose X_WH_;
  spatial::Twist V_WH_;
};

}  // namespace hvas::simulation
