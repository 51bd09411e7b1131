#include "person/person_at_device.h"

#include <algorithm>
#include <cmath>

namespace hvas::person {
namespace {

// Muscles build up their force in some ten milliseconds: a wish reaches the hand through three
// such delays, without a jerk.
constexpr double kMuscleTime = 0.02;  // [s]

}  // namespace

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

device::DeviceState PersonAtDevice::Step(const simulation::OperatorInput& input) noexcept {
  const simulation::HandReference reference = person_->Intend(input);
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
  device::DeviceState state = simulation::ReadDevice(device_);
  state.client_age_ns = reference.client_age_ns;
  return state;
}

}  // namespace hvas::person
