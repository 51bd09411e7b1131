#pragma once

#include <cstdint>

#include "device/device.h"
#include "haptics/options.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"
#include "haptics/tick_output.h"
#include "haptics/workspace.h"

namespace hvas::haptics {

/** The last stage of a tick: torque as a cue where the device has none, passivity control, and the
 safety gate (N6). RT-safe. */
class DeviceOutput {
 public:
  /** What is known when the wrench goes out. */
  struct Input {
    spatial::Wrench F_H_W;    ///< Wanted, about the hand's point.
    bool is_usable{false};    ///< The device's sample is valid and finite.
    bool has_engaged{false};  ///< A part was taken or a mate captured in this tick.
    double stored{0};  ///< Energy held by springs, masses and heights, of the hand's work [J].
    double stored_turning{0};  ///< Energy held by springs of rotation [J].
  };

  explicit DeviceOutput(const TickOptions& options) noexcept;

  /** The wrench that the device may be given, about the hand's point in its base. */
  [[nodiscard]] spatial::Wrench Pass(const device::DeviceState& state, const TickContext& context,
                                     const Workspace& workspace, const Input& input) noexcept;

  void AddCredit(double energy) noexcept { passivity_.AddCredit(energy); }

  void AddTurningCredit(double energy) noexcept { passivity_.AddTurningCredit(energy); }

  [[nodiscard]] const PassivityController& passivity() const noexcept { return passivity_; }

  /** Bits of GateAction: what the gate had to do. */
  [[nodiscard]] std::uint32_t gate_actions() const noexcept { return gate_.actions(); }

 private:
  [[nodiscard]] Vec3 CalcTorqueCue(const spatial::Wrench& F_H_D, const Quat& q_DH) const noexcept;

  const TickOptions& options_;
  PassivityController passivity_;
  SafetyGate gate_;
  std::int64_t last_sample_ns_{0};
};

}  // namespace hvas::haptics
