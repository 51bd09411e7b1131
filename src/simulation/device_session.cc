#include "simulation/device_session.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "haptics/coupling_rule.h"
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
constexpr double kThermalTime = 10;  // [s]
// Muscles build up their force in some ten milliseconds: a wish reaches the hand through three
// such delays, without a jerk.
constexpr double kMuscleTime = 0.02;      // [s]
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
  if (info.capabilities.force_axes > 0 && info.capabilities.torque_axes == 0) {
    options.p_HG = kGripBehindPoint;
  }
  return options;
}

PersonOptions MakePersonOptions(const haptics::TickOptions& options) {
  constexpr double kPushShare = 0.86;  // above what fits are felt with at most
  constexpr double kSlack = 5e-3;      // [m]
  PersonOptions habits;
  const double push_limit = kPushShare * options.device.max_force;
  habits.push_rate *= std::max(1.0, push_limit / habits.push_limit);
  habits.push_limit = push_limit;
  habits.most_stretch = options.device.max_force / options.coupling.k_lin + kSlack;
  return habits;
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
  notes.push_back(
      fmt::format("1 mm of the device is {:.3g} mm of the scene", options.workspace.mapping.scale));
  notes.push_back(fmt::format("the hand holds a part with {:.0f} N/m, {:.2g} N s/m; {:.2g} N m/rad",
                              options.coupling.k_lin, options.coupling.b_lin,
                              options.coupling.k_rot));
  return notes;
}

device::DeviceState ReadDevice(device::Device* device) noexcept {
  device::DeviceState state = device->Read();
  state.sample_ns = state.t_ns;
  return state;
}

Vec3 PersonAtDevice::FollowSmoothly(const Vec3& p_DR, double dt) noexcept {
  Vec3 wanted = p_DR;
  Vec3 v = Vec3::Zero();
  for (Vec3& p : muscles_) {
    v = (wanted - p) / std::max(dt, kMuscleTime);
    p += dt * v;
    wanted = p;
  }
  return v;
}

device::DeviceState PersonAtDevice::Step(const OperatorInput& input) noexcept {
  const HandReference reference = person_->Intend(input);
  const PersonOptions& arm = person_->options();
  const Quat q_DW = input.workspace.X_WD.q().conjugate();
  device::HandIntent hand;
  hand.X_DR = haptics::MapPoseToDevice(input.workspace, reference.X_WR);
  // Nobody tears at the stops: at the edge, the border carries the hand on.
  const Vec3 edge = 0.5 * device_->info().profile.workspace;
  const Vec3 within = hand.X_DR.p().cwiseMax(-edge).cwiseMin(edge);
  hand.V_DR.v = FollowSmoothly(within, input.dt);
  hand.X_DR = {hand.X_DR.q(), muscles_.back()};
  hand.stiffness = arm.stiffness;
  hand.damping = arm.damping;
  hand.mass = arm.mass;
  hand.turn_stiffness = arm.turn_stiffness;
  hand.turn_damping = arm.turn_damping;
  hand.inertia = arm.inertia;
  hand.force = q_DW * reference.f_W;
  hand.buttons = reference.is_gripping ? 1 : 0;
  hand.grip = reference.is_gripping ? 1 : 0;
  emulator_->device().SetHand(hand);
  if (!is_live_) {
    emulator_->Advance(std::llround(1e9 * input.dt));
  }
  return ReadDevice(device_);
}

}  // namespace hvas::simulation
