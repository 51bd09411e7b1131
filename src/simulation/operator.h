#pragma once

#include "device/device.h"
#include "haptics/haptic_tick.h"

namespace hvas::simulation {

/** What reaches a person's hand, ear and eye in a millisecond: the wrench of the device, the sounds
 of capture and of seating (W7), and the part on the screen. Nothing else of the simulation's state.
 */
struct OperatorInput {
  std::int64_t t_ns{0};
  double dt{1e-3};        ///< Since the last sample [s].
  spatial::Wrench F_H_D;  ///< Wrench on the hand, in the device's base frame.
  bool hears_capture{false};
  bool hears_seated{false};
  bool sees_part{false};                ///< Something is in the hand.
  spatial::Pose X_WD;                   ///< The held part as displayed.
  spatial::Pose X_WH;                   ///< The hand on the screen.
  haptics::WorkspaceMapping workspace;  ///< How the hand's motion moves it.
};

/** What moves the hand: a device driver, a recording, or a simulated person. The rest of the
 program cannot tell them apart. */
class Operator {
 public:
  Operator() = default;
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;
  virtual ~Operator() = default;

  /** The device's next sample. RT-safe. */
  virtual device::DeviceState Step(const OperatorInput& input) noexcept = 0;

  /** The wrench of the tick that this sample went into, for a device to show. RT-safe. */
  virtual void Apply(const spatial::Wrench& F_H_D) noexcept { (void)F_H_D; }
};

}  // namespace hvas::simulation
