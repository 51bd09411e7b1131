#pragma once

#include <atomic>
#include <cstdint>

#include "base/clock.h"
#include "base/triple_buffer.h"
#include "person/simulated_person.h"

namespace hvas::studio {

/** A client's target for the hand. */
struct PointerInput {
  std::int64_t t_ns{0};  ///< Time of its arrival, by the clock of the session.
  spatial::Pose X_WH;
  bool is_gripping{false};
};

/** A hand that a remote client moves, with a mouse or a controller in a browser (X5). Inputs arrive
 60 to 120 times a second, with jitter and gaps. The hand follows the newest one through a low-pass
 filter of second order, with a limited speed; it reports the age of the input, by which the safety
 gate removes the force and the motion stops. With an emulated device in the hand, the mechanics of
 the device move the hand. Step and Intend are for the haptic thread, Move for one other thread.
 RT-safe. */
class PointerOperator final : public simulation::Operator, public person::DeviceHolder {
 public:
  /** Age at which the input times out [ns]. */
  static constexpr std::int64_t kInputTimeoutNs = 250'000'000;

  /** @param clock  By which the age of an input is told; outlives this. */
  PointerOperator(const spatial::Pose& X_WH, const Clock& clock);

  /** Sets the target; may be called at any time, and the newest one counts. */
  void Move(const PointerInput& input) noexcept { inputs_.Write(input); }

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] simulation::HandReference Intend(
      const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] const person::PersonOptions& options() const noexcept override { return options_; }

 private:
  /** Reads the newest input and calculates its age. */
  const PointerInput& ReadInput(bool sees_part, std::int64_t* age_ns) noexcept;
  void Follow(const spatial::Pose& X_WH, double dt) noexcept;

  const Clock& clock_;
  person::PersonOptions options_;
  TripleBuffer<PointerInput> inputs_;
  spatial::Pose X_WH_;
  spatial::Pose X_WS_;  ///< State of the first of the filter's two stages.
  spatial::Twist V_H_;
};

}  // namespace hvas::studio
