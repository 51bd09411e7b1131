#include "app/devices/floor_trial.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "simulation/device_session.h"

namespace hvas::app {

FloorTrial::FloorTrial(device::Device* device, double rate_hz, const Clock& clock)
    : device_(device),
      clock_(clock),
      last_ns_(clock.NowNs()),
      up_D_(device->info().profile.q_UD.conjugate() * Vec3::UnitZ()),
      gains_(haptics::ChooseCoupling(device->info().profile, 1, 1 / rate_hz)),
      passivity_(haptics::MakePassivityController(device->info().profile, 1 / rate_hz)),
      gate_(haptics::MakeSafetyLimits(device->info().profile)) {}

spatial::Wrench FloorTrial::CalcFloor(const device::DeviceState& now) const noexcept {
  const double depth = -up_D_.dot(now.X_DH.p());
  spatial::Wrench F;
  if (now.is_valid && depth > 0) {
    F.f = std::max(0.0, gains_.k_lin * depth - gains_.b_lin * up_D_.dot(now.V_DH.v)) * up_D_;
  }
  return F;
}

void FloorTrial::Tick() noexcept {
  TrialState& state = states_.back();
  state.device = simulation::ReadDevice(device_);
  const device::DeviceState& now = state.device;
  const std::int64_t now_ns = clock_.NowNs();
  // The time since the last tick, not the period: what is late must not look like a leap.
  const double dt = 1e-9 * static_cast<double>(now_ns - std::exchange(last_ns_, now_ns));
  const std::int64_t since_write_ns = pace_.Begin(now_ns);
  if (haptics::SafetyGate::IsStall(since_write_ns)) {
    passivity_.ForgetWritten();
  }
  const spatial::Wrench wanted =
      passivity_.Limit(now.X_DH, CalcFloor(now), std::numeric_limits<double>::quiet_NaN(), 0, dt);
  haptics::GateInput input = haptics::MakeGateInput(now, wanted, dt, &last_sample_ns_);
  input.since_write_ns = since_write_ns;
  state.F_H_D = pace_.Admit(gate_.Pass(input), clock_.NowNs());
  passivity_.Write(state.F_H_D);
  device_->Write(state.F_H_D);
  state.gate_actions = gate_.actions();
  states_.Publish();
}

}  // namespace hvas::app
