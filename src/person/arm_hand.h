#pragma once

#include "person/simulated_person.h"
#include "simulation/operator.h"

namespace hvas::person {

/** Moves a hand by one sample: mass, spring and damper of the arm draw it to the reference, against
 the wrench of the device. RT-safe.
 @param F_H_W  Wrench of the device on the hand.
 @param X_WH,V_WH  Pose and twist of the hand, which are moved on by dt [s]. */
void AdvanceArm(const PersonOptions& arm, const HandReference& reference,
                const spatial::Wrench& F_H_W, double dt, spatial::Pose* X_WH,
                spatial::Twist* V_WH) noexcept;

/** A hand that a program leads: the impedance of an arm draws it to the reference that was set
 last, and what it meets pushes it back. Without stiffness it follows the force alone. */
class ArmHand final : public simulation::Operator {
 public:
  /** @param arm  Of these options the impedance only. */
  ArmHand(const PersonOptions& arm, const spatial::Pose& X_WH);

  /** Sets where the hand is to be from the next sample on. On the thread of the ticks. */
  void Lead(const HandReference& reference) noexcept { reference_ = reference; }

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] const spatial::Pose& X_WH() const noexcept { return X_WH_; }

 private:
  PersonOptions arm_;
  HandReference reference_;
  spatial::Pose X_WH_;
  spatial::Twist V_WH_;
};

}  // namespace hvas::person
