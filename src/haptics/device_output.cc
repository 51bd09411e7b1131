#include "haptics/device_output.h"

#include <algorithm>
#include <limits>

namespace hvas::haptics {
namespace {

SafetyLimits MakeGateLimits(const TickOptions& options) noexcept {
  if (options.limits) {
    return *options.limits;
  }
  SafetyLimits limits;
  limits.max_force = options.device.max_force;
  limits.max_torque = options.device.max_torque;
  limits.max_torque_rate = 40;
  return limits;
}

}  // namespace

DeviceOutput::DeviceOutput(const TickOptions& options) noexcept
    : options_(options),
      passivity_(MakePassivityController(options.device, options.dt)),
      gate_(MakeGateLimits(options)) {}

spatial::Wrench DeviceOutput::Pass(const device::DeviceState& state, const TickContext& context,
                                   const Workspace& workspace, const Input& input) noexcept {
  spatial::Wrench F_H_D = workspace.ToDevice(input.F_H_W);
  if (options_.controls_passivity) {
    F_H_D.f += CalcTorqueCue(F_H_D, state.X_DH.q());
    if (SafetyGate::IsStall(context.since_write_ns)) {
      passivity_.ForgetWritten();
    }
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const spatial::Pose nowhere(Vec3::Constant(kNan));
    F_H_D = passivity_.Limit(input.is_usable ? state.X_DH : nowhere, F_H_D, input.stored,
                             input.stored_turning, options_.dt);
  }
  GateInput gate = MakeGateInput(state, F_H_D, options_.dt, &last_sample_ns_);
  gate.is_valid = gate.is_valid && input.is_usable;
  gate.is_stopped = gate.is_stopped || context.is_stopped;
  gate.has_engaged = input.has_engaged;
  gate.model_age = 1e-9 * static_cast<double>(context.model_age_ns);
  gate.since_write_ns = context.since_write_ns;
  spatial::Wrench given = gate_.Pass(gate);
  if (options_.controls_passivity) {
    passivity_.Write(given);
    // The border moves the scene under the hand: work that the handle would have done (X5).
    const double drift_work =
        -given.f.dot(workspace.drift_D()) * options_.dt / options_.workspace.mapping.scale;
    if (drift_work > 0) {
      passivity_.AddCredit(drift_work);
    }
  }
  return given;
}

Vec3 DeviceOutput::CalcTorqueCue(const spatial::Wrench& F_H_D, const Quat& q_DH) const noexcept {
  // The force at the handle's point that turns the hand, which holds it at G, by this torque; what
  // lies along the lever cannot be shown.
  const double lever = options_.p_HG.norm();
  if (!(lever > 0)) {
    return Vec3::Zero();
  }
  constexpr double kCueShare = 0.06;  // of the force: a cue, that moves no part aside
  const Vec3 r_D = q_DH * Vec3(-options_.p_HG);
  const Vec3 f = F_H_D.t.cross(r_D) / (lever * lever);
  const double most = kCueShare * options_.device.max_force;
  return f * std::min(1.0, most / std::max(f.norm(), most));
}

}  // namespace hvas::haptics
