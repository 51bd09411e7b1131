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
  constexpr double kLeastShare = 0.1;  // Share of the mass that is felt without a device: a choice.
  // Heavier than its force can carry about, a part swings to and fro on its coupling.
  const double strength = options.device.max_force / device::DeviceProfile().max_force;
  options.max_virtual_mass *= std::clamp(strength, kLeastShare, 1.0);
  if (info.capabilities.force_axes > 0 && info.capabilities.torque_axes == 0) {
    options.p_HG = kGripBehindPoint;
  }
  return options;
}

PersonOptions MakePersonOptions(const haptics::TickOptions& options) {
  constexpr double kPushShare = 0.86;  // above what fits are felt with at most
  constexpr double kSlack = 5e-3;      // [m] beyond the stretch of full force: a choice.
  constexpr double kPatience = 1.6;    // of a hand that has no device between itself and the part
  PersonOptions habits;
  const double push_limit = kPushShare * options.device.max_force;
  habits.push_rate *= std::max(1.0, push_limit / habits.push_limit);
  // Weaker devices are pressed with less from the beginning, stronger ones only where a fit
  // resists.
  const double share = std::min(1.0, push_limit / habits.push_limit);
  habits.first_push *= share;
  habits.careful_push *= share;
  habits.light_push *= share;
  habits.unguided_limit *= share;
  habits.push_limit = push_limit;
  habits.patience_s *= kPatience;
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

const Vec3& Muscles::Follow(const Vec3& wanted, double dt, Vec3* rate) noexcept {
  Vec3 next = wanted;
  for (Vec3& stage : stages_) {
    *rate = (next - stage) / std::max(dt, kMuscleTime);
    stage += dt * *rate;
    next = stage;
  }
  return stages_.back();
}

void PersonAtDevice::Reach(const Vec3& p_DR, const Vec3& p_DH, double dt,
                           device::HandIntent* hand) noexcept {
  // Nobody tears at the stops: at the edge, the border carries the hand on. But whoever presses on
  // what stands still presses as hard from there as from anywhere, and less towards the stop.
  const haptics::WorkspaceOptions border;
  const Vec3 edge = 0.5 * device_->info().profile.workspace;
  const Vec3 within = p_DR.cwiseMax(-edge).cwiseMin(edge);
  Vec3 rate;
  const Vec3 beyond = beyond_.Follow(p_DR - within, dt, &rate);
  hand->X_DR = {hand->X_DR.q(), place_.Follow(within, dt, &hand->V_DR.v)};
  for (int k = 0; k < 3; ++k) {
    const double room = edge[k] - std::copysign(1.0, beyond[k]) * p_DH[k];
    const double share = std::clamp(room / (border.border_share * edge[k]), 0.0, 1.0);
    hand->force[k] += share * hand->stiffness * beyond[k];
  }
}

device::DeviceState PersonAtDevice::Step(const OperatorInput& input) noexcept {
  const HandReference reference = person_->Intend(input);
  const PersonOptions& arm = person_->options();
  const Quat q_DW = input.workspace.X_WD.q().conjugate();
  device::HandIntent hand;
  hand.X_DR = haptics::MapPoseToDevice(input.workspace, reference.X_WR);
  hand.stiffness = arm.stiffness;
  hand.damping = arm.damping;
  hand.mass = arm.mass;
  hand.turn_stiffness = arm.turn_stiffness;
  hand.turn_damping = arm.turn_damping;
  hand.inertia = arm.inertia;
  hand.force = q_DW * reference.f_W;
  Reach(hand.X_DR.p(), haptics::MapPoseToDevice(input.workspace, input.X_WH).p(), input.dt, &hand);
  hand.buttons = reference.is_gripping ? 1 : 0;
  hand.grip = reference.is_gripping ? 1 : 0;
  emulator_->device().SetHand(hand);
  if (!is_live_) {
    emulator_->Advance(std::llround(1e9 * input.dt));
  }
  device::DeviceState state = ReadDevice(device_);
  state.client_age_ns = reference.client_age_ns;
  return state;
}

}  // namespace hvas::simulation
