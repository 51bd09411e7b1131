#pragma once

#include <cstdint>

#include "base/clock.h"
#include "base/triple_buffer.h"
#include "device/device.h"
#include "haptics/coupling_rule.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"
#include "haptics/write_pace.h"

namespace hvas::app {

/** A tick of a trial, for whoever watches. */
struct TrialState {
  device::DeviceState device;
  spatial::Wrench F_H_D;
  std::uint32_t gate_actions{0};
};

/** A horizontal floor through D's origin, felt through passivity control and the gate. */
class FloorTrial {
 public:
  /** @param device,clock  Outlive this object; the clock is that of the loop that calls Tick(). */
  FloorTrial(device::Device* device, double rate_hz, const Clock& clock);

  /** Reads, computes and writes. One thread; RT-safe as far as the device is. */
  void Tick() noexcept;

  /** The newest state, for one other thread. */
  const TrialState& ReadState() {
    states_.Update();
    return states_.value();
  }

  [[nodiscard]] const haptics::CouplingGains& gains() const { return gains_; }

 private:
  [[nodiscard]] spatial::Wrench CalcFloor(const device::DeviceState& now) const noexcept;

  device::Device* device_;
  const Clock& clock_;
  std::int64_t last_ns_;  ///< Time of the last tick.
  std::int64_t last_sample_ns_{0};
  Vec3 up_D_;
  haptics::CouplingGains gains_;
  haptics::PassivityController passivity_;
  haptics::SafetyGate gate_;
  haptics::WritePace pace_;
  TripleBuffer<TrialState> states_;
};

}  // namespace hvas::app
