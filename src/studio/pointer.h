#pragma once

#include <atomic>
#include <cstdint>

#include "base/triple_buffer.h"
#include "simulation/simulated_person.h"

namespace hvas::studio {

/** Where a client wants the hand, and since when. */
struct PointerInput {
  std::int64_t t_ns{0};  ///< Arrival, by MonotonicNs().
  spatial::Pose X_WH;
  bool is_gripping{false};
};

/** A hand that is moved from afar, by a mouse or a controller in a browser (X5). Inputs come when
 they come, 60 to 120 times a second or late: the hand follows the newest one smoothly, no faster
 than a hand moves, and says how old it is, so that the gate can take the force away and nothing
 moves on. With an emulated device in the hand, the device's mechanics take the hand there. Step and
 Intend belong to the haptic thread, Move to one other thread. RT-safe. */
class PointerOperator final : public simulation::Operator, public simulation::DeviceHolder {
 public:
  static constexpr std::int64_t kSilentNs = 250'000'000;  ///< After so long without input.

  explicit PointerOperator(const spatial::Pose& X_WH);

  /** Any time; newest wins. */
  void Move(const PointerInput& input) noexcept { inputs_.Write(input); }

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] simulation::HandReference Intend(
      const simulation::OperatorInput& input) noexcept override;

  [[nodiscard]] const simulation::PersonOptions& options() const noexcept override {
    return options_;
  }

 private:
  /** The newest wish, and its age. */
  const PointerInput& Listen(bool sees_part, std::int64_t* age_ns) noexcept;
  void Follow(const spatial::Pose& X_WH, double dt) noexcept;

  simulation::PersonOptions options_;
  TripleBuffer<PointerInput> inputs_;
  spatial::Pose X_WH_;
  spatial::Pose X_WS_;  ///< The first of the two stages that smooth the way.
  spatial::Twist V_H_;
};

}  // namespace hvas::studio
