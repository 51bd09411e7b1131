#include "assembly/hand.h"

#include <utility>

#include "base/check.h"
#include "person/person_at_device.h"
#include "simulation/assembly_run.h"
#include "simulation/guided_hand.h"

namespace hvas::assembly {
namespace {

std::unique_ptr<person::SimulatedPerson> MakePerson(const simulation::Model& model,
                                                    const person::PersonOptions& habits,
                                                    std::uint64_t seed) {
  return std::make_unique<person::SimulatedPerson>(habits, seed, simulation::StartOfHand(model));
}

}  // namespace

haptics::TickOptions MakePersonTick(const simulation::RenderOptions& render) {
  haptics::TickOptions tick;
  tick.device.name = "simulated 6-DoF device";
  tick.dt = 1 / render.rate_hz;
  return tick;
}

Hand MakePersonHand(const simulation::Model& model, const haptics::TickOptions& tick,
                    const person::PersonOptions& habits, std::uint64_t seed) {
  Hand hand;
  hand.tick = tick;
  hand.mover = MakePerson(model, habits, seed);
  return hand;
}

Hand MakeGuidedHand(const simulation::Model& model, const simulation::RenderOptions& render) {
  Hand hand;
  hand.tick.device.name = "guided hand";
  hand.tick.device.max_force = 1.2 * simulation::kMostHandForce;  // The coupling has nine tenths.
  hand.tick.device.max_torque = 20;
  hand.tick.coupling = {4000, 90, 60, 3};
  hand.tick.guidance.captures_on_straight_end = true;  // It needs no guidance to find its way.
  hand.tick.dt = 1 / render.rate_hz;
  hand.mover = std::make_unique<simulation::GuidedHand>(simulation::StartOfHand(model));
  return hand;
}

Hand MakeDeviceHand(const simulation::Model& model, device::OpenedDevice opened,
                    const haptics::TickOptions& tick, std::uint64_t seed, bool is_live) {
  HVAS_DEMAND(opened.device != nullptr);
  Hand hand;
  hand.opened = std::move(opened);
  hand.tick = tick;
  if (hand.opened.emulator == nullptr) {
    hand.at_device = std::make_unique<simulation::DeviceOperator>(hand.opened.device.get());
    return hand;
  }
  auto person = MakePerson(model, person::MakePersonOptions(tick), seed);
  hand.at_device = std::make_unique<person::PersonAtDevice>(
      person.get(), hand.opened.emulator.get(), hand.opened.device.get(), is_live);
  hand.mover = std::move(person);
  return hand;
}

Result<Hand> MakeHand(const simulation::Model& model, const HandOptions& options) {
  if (options.device.empty()) {
    return options.person ? MakePersonHand(model, MakePersonTick(options.render),
                                           person::MakeHabits(*options.person, {}), options.seed)
                          : MakeGuidedHand(model, options.render);
  }
  auto opened = device::OpenAnyDevice(options.device, options.is_live);
  if (!opened) {
    return Unexpected(opened.error());
  }
  const haptics::TickOptions tick =
      simulation::MakeTickOptions(opened->device->info(), model, options.render);
  Hand hand = MakeDeviceHand(model, std::move(*opened), tick, options.seed, options.is_live);
  hand.address = options.device;
  return hand;
}

std::vector<DeviceInHand> DescribeDevices(const std::vector<Hand>& hands) {
  std::vector<DeviceInHand> devices;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const Hand& hand = hands[i];
    if (hand.opened.device != nullptr) {
      const device::DeviceInfo& info = hand.opened.device->info();
      devices.push_back({i, hand.address, info.model, info.profile.id, info.is_emulated,
                         simulation::DescribeRendering(info, hand.tick)});
    }
  }
  return devices;
}

}  // namespace hvas::assembly
