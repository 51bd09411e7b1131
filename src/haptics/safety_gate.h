#pragma once

#include <cstdint>

#include "spatial/pose.h"

namespace hvas::haptics {

/** What the device may be given. SI. */
struct SafetyLimits {
  double max_force{7.0};       ///< [N]
  double max_torque{0.4};      ///< [N m]
  double max_force_rate{400};  ///< [N/s]; 0.4 N in a millisecond.
  double max_torque_rate{20};  ///< [N m/s]
};

/** Why the gate changed a wrench; a bit mask. */
enum GateAction : std::uint32_t {
  kGatePassed = 0,
  kGateNotFinite = 1u << 0,  ///< NaN or infinity came in: decays to zero.
  kGateMagnitude = 1u << 1,  ///< Norm limited, direction kept.
  kGateRate = 1u << 2,       ///< Change limited.
};

/** The last thing before every device write: finite, limited in norm and in rate (N6). Keeps the
 last wrench it let through. RT-safe. */
class SafetyGate {
 public:
  explicit SafetyGate(const SafetyLimits& limits) : limits_(limits) {}

  /** Returns the wrench that may go to the device. Never not finite, never beyond the limits. */
  [[nodiscard]] spatial::Wrench Pass(const spatial::Wrench& F_W, double dt) noexcept;

  /** What the last Pass had to do. */
  [[nodiscard]] std::uint32_t actions() const noexcept { return actions_; }

  [[nodiscard]] const SafetyLimits& limits() const noexcept { return limits_; }

 private:
  SafetyLimits limits_;
  spatial::Wrench last_;
  std::uint32_t actions_{kGatePassed};
};

}  // namespace hvas::haptics
