#pragma once

#include "simulation/arm.h"
#include "simulation/operator.h"

namespace hvas::person {

/** A hand that a program leads: the impedance of an arm draws it to the reference that was set
 last, and what it meets pushes it back. Without stiffness it follows the force alone. */
class ArmHand final : public simulation::Operator {
 public:
  ArmHand(const simulation::Arm& arm, const spatial::Pose& X_WH);

  /** Sets where the hand is to be from the next sample on. On the thread of the ticks. */
  void Lead(const simulation::HandReference& reference) noexcept { reference_ = reference; }

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] const spatial::Pose& X_WH() const noexcept { return X_WH_; }

 private:
  simulation::Arm arm_;
  simulation::HandReference reference_;
  spatial::Pose X_WH_;
  spatial::Twist V_WH_;
};

}  // namespace hvas::person
