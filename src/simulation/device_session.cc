#include "simulation/device_session.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "haptics/coupling_rule.h"
#include "haptics/passivity_controller.h"
#include "simulation/assembly_run.h"

namespace hvas::simulation {
namespace {

// One to one up to products of this size, so that the hand knows its way; larger ones are brought
// down to it, smaller ones enlarged, as far as a hand is finer than they are.
constexpr double kLargestRadius = 0.4;    // [m] of the way around the product
constexpr double kSmallestRadius = 0.06;  // [m]
constexpr double kFinestScale = 0.2;
// The tick answers contact by itself, with or without the physics loop; what a late one keeps from
// happening is the taking up and letting go. A late loop is normal on a loaded machine, a dead one
// is not.
constexpr double kModelHold = 0.2;  // [s]
// Continuous forces are what motors stand for a day; they take longer than a press to get warm.
constexpr double kThermalTime = 10;       // [s]
const Vec3 kGripBehindPoint{0, 0, 0.04};  // [m]; where a stylus is held

double ChooseScale(const Model& model) {
  const double radius = model.transfer_radius;
  if (radius > kLargestRadius) {
    return radius / kLargestRadius;
  }
  return std::max(kFinestScale, std::min(1.0, radius / kSmallestRadius));
}

/** As it is rendered: what a device lacks is as the simulated one has it. */
device::DeviceProfile MakeRendered(const device::DeviceInfo& info) {
  device::DeviceProfile profile = info.profile;
  const device::DeviceProfile simulated;
  if (info.capabilities.force_axes == 0) {
    profile.max_force = simulated.max_force;
    profile.max_torque = simulated.max_torque;
  } else if (info.capabilities.torque_axes == 0) {
    profile.max_torque = 0;
  }
  return profile;
}

device::DeviceProfile MakeGiven(const device::DeviceInfo& info) {
  device::DeviceProfile profile = info.profile;
  if (info.capabilities.force_axes == 0) {
    profile.max_force = 0;
  }
  if (info.capabilities.torque_axes == 0) {
    profile.max_torque = 0;
  }
  return profile;
}

}  // namespace

haptics::TickOptions MakeTickOptions(const device::DeviceInfo& info, const Model& model,
                                     const RenderOptions& render) {
  haptics::TickOptions options;
  options.dt = 1 / render.rate_hz;
  options.device = MakeRendered(info);
  const device::DeviceProfile given = MakeGiven(info);
  options.limits = haptics::MakeSafetyLimits(given);
  options.limits->model_hold = kModelHold;
  options.limits->thermal_time = kThermalTime;
  options.controls_passivity = info.capabilities.force_axes > 0;
  const double scale = render.scale > 0 ? render.scale : ChooseScale(model);
  options.workspace.mapping.scale = scale;
  const Quat& q_UD = info.profile.q_UD;  // the user sits as the scene stands
  options.workspace.mapping.X_WD = {q_UD, StartOfHand(model).p()};
  options.workspace.mapping.q_index = q_UD.conjugate();
  options.workspace.box = info.profile.workspace;
  options.workspace.border_speed *= std::max(1.0, scale);
  options.workspace.border_force = std::min(options.workspace.border_force, 0.3 * given.max_force);
  options.coupling = haptics::ChooseCoupling(given, scale, options.dt);
  constexpr double kLeastShare = 0.1;  // Share of the mass that is felt without a device: a choice.
  // Heavier than its force can carry about, a part swings to and fro on its coupling.
  const double strength = options.device.max_force / device::DeviceProfile().max_force;
  options.max_virtual_mass *= std::clamp(strength, kLeastShare, 1.0);
  if (info.capabilities.force_axes > 0 && info.capabilities.torque_axes == 0) {
    options.p_HG = kGripBehindPoint;
  }
  return options;
}

std::vector<std::string> DescribeRendering(const device::DeviceInfo& info,
                                           const haptics::TickOptions& options) {
  std::vector<std::string> notes;
  const device::Capabilities& can = info.capabilities;
  if (info.is_emulated) {
    notes.push_back("this is an EMULATED device");
  }
  if (can.force_axes == 0) {
    notes.push_back(can.can_rumble
                        ? "it shows no forces: they are computed as for the simulated device, and "
                          "their size is felt as vibration"
                        : "it shows no forces: they are computed as for the simulated device, and "
                          "seen only");
  } else if (can.torque_axes == 0) {
    notes.push_back(fmt::format(
        "it shows forces but no torques: a torque becomes the force that turns the hand about its "
        "grip, {:.0f} mm from the device's point",
        1e3 * options.p_HG.norm()));
  }
  if (!can.senses_position) {
    notes.push_back("it senses deflections: the hand moves as fast as it is deflected");
  } else if (!can.senses_rotation) {
    notes.push_back("it senses no rotation: parts keep how they are turned");
  }
  const double delay = haptics::CalcDelayTicks(options.device, options.dt);
  if (options.controls_passivity && delay > haptics::PassivityChannel::kMaxDelay) {
    notes.push_back(fmt::format(
        "its delay is {:.0f} ticks; the passivity controller takes it for {}, so that energy may "
        "reach the hand unnoticed",
        delay, haptics::PassivityChannel::kMaxDelay));
  }
  notes.push_back(
      fmt::format("1 mm of the device is {:.3g} mm of the scene", options.workspace.mapping.scale));
  notes.push_back(fmt::format("the hand holds a part with {:.0f} N/m, {:.2g} N s/m; {:.2g} N m/rad",
                              options.coupling.k_lin, options.coupling.b_lin,
                              options.coupling.k_rot));
  return notes;
}

device::DeviceState ReadDevice(device::Device* device) noexcept {
  device::DeviceState state = device->Read();
  if (state.sample_ns == 0) {
    state.sample_ns = state.t_ns;  // Such a driver keeps the time of a sample that it repeats.
  }
  return state;
}

}  // namespace hvas::simulation
