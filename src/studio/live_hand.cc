#include "studio/live_hand.h"

#include "person/person_at_device.h"

namespace hvas::studio {
namespace {

constexpr double kFinishDistance = 3e-3;  // [m]; a part released so near its place is seated

/** Removes the force when the client's input times out; the part then stays where it is. */
void AddClientLimits(haptics::SafetyLimits* limits) {
  limits->client_hold = 1e-9 * static_cast<double>(PointerOperator::kInputTimeoutNs);
  limits->client_fade = 0.25;  // [s]
}

haptics::TickOptions MakeOptions(const HandSetup& setup, const HandPurpose& purpose,
                                 bool goes_through_device, const simulation::Model& model) {
  if (!goes_through_device) {
    return MakePointerOptions(purpose.rate_hz);
  }
  haptics::TickOptions options = simulation::MakeTickOptions(setup.device->device->info(), model,
                                                             {setup.scale, purpose.rate_hz});
  if (setup.device->emulator != nullptr && !purpose.has_person) {
    AddClientLimits(&*options.limits);
  }
  return options;
}

}  // namespace

haptics::TickOptions MakePointerOptions(double rate_hz) {
  constexpr double kModelHold = 0.2;  // [s]; equal to that of a device
  haptics::TickOptions options;
  options.dt = 1 / rate_hz;
  options.device.name = "pointer";
  options.limits = haptics::MakeSafetyLimits(options.device);
  // The detectors for motor heat, kick and torn-away handles have no meaning without a device.
  options.limits->has_detectors = false;
  options.limits->continuous_force = haptics::SafetyLimits::kNever;
  options.limits->continuous_torque = haptics::SafetyLimits::kNever;
  options.limits->fade_speed = haptics::SafetyLimits::kNever;
  options.limits->cut_speed = haptics::SafetyLimits::kNever;
  options.limits->model_hold = kModelHold;
  AddClientLimits(&*options.limits);
  return options;
}

// A hand of its own instead of assembly::Hand: a pointer moves it, too, by itself or with an
// emulated device in the hand; the device outlives the run; and a simulated person works beside a
// real device.
LiveHand::LiveHand(const HandSetup& setup, const HandPurpose& purpose,
                   const simulation::Model& model)
    : device_(setup.device), pointer_(purpose.X_WH, *purpose.clock) {
  const bool is_emulated = device_ != nullptr && device_->emulator != nullptr;
  const bool goes_through_device = is_emulated || (device_ != nullptr && !purpose.has_person);
  tick_options_ = MakeOptions(setup, purpose, goes_through_device, model);
  if (purpose.trial != nullptr) {
    purpose.trial->Adjust(goes_through_device, &tick_options_);
  } else {
    tick_options_.guidance.finish_distance = kFinishDistance;
    haptics::Apply(purpose.guidance, &tick_options_);
  }
  if (purpose.has_person) {
    person_ = std::make_unique<person::SimulatedPerson>(
        is_emulated ? person::MakePersonOptions(tick_options_) : person::PersonOptions(),
        purpose.seed, purpose.X_WH);
  }
  if (is_emulated) {
    person::DeviceHolder* holder = &pointer_;
    if (person_ != nullptr) {
      holder = person_.get();
    }
    const bool is_live = !purpose.clock->is_steered();
    at_device_ = std::make_unique<person::PersonAtDevice>(holder, device_->emulator.get(),
                                                          device_->device.get(), is_live);
  } else if (goes_through_device) {
    at_device_ = std::make_unique<simulation::DeviceOperator>(device_->device.get());
  }
  follows_pointer_ = person_ == nullptr && (is_emulated || device_ == nullptr);
  active_ = at_device_.get();
  if (active_ == nullptr) {
    active_ = person_ != nullptr ? static_cast<simulation::Operator*>(person_.get()) : &pointer_;
  }
}

}  // namespace hvas::studio
