#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "device/opened_device.h"
#include "haptics/options.h"
#include "simulation/device_session.h"
#include "simulation/model.h"
#include "simulation/operator.h"
#include "simulation/simulated_person.h"

namespace hvas::assembly {

/** What moves one hand of a run: a simulated person, alone or with an emulated device in the hand,
 or whoever holds a real device. */
struct Hand {
  std::string address;          ///< The device's, as it was asked for; empty: none.
  device::OpenedDevice opened;  ///< Empty without a device.
  haptics::TickOptions tick;
  std::unique_ptr<simulation::SimulatedPerson> person;  ///< Null where a real one has this hand.
  std::unique_ptr<simulation::Operator> at_device;      ///< Null without a device.

  /** What gives the samples of this hand; never null in a hand that is made by a function below. */
  [[nodiscard]] simulation::Operator* active() const {
    return at_device != nullptr ? at_device.get() : person.get();
  }
};

/** Options of the tick for a simulated person without a device: as with a device of six degrees of
 freedom whose forces have no limits. */
[[nodiscard]] haptics::TickOptions MakePersonTick(const simulation::RenderOptions& render);

/** The hand of a simulated person without a device. The same habits and seed give the same hand. */
[[nodiscard]] Hand MakePersonHand(const simulation::Model& model, const haptics::TickOptions& tick,
                                  const simulation::PersonOptions& habits, std::uint64_t seed);

/** A hand that holds a device: an emulated one in the hand of a simulated person with this seed, a
 real one in the hand of whoever is there.
 @param tick  Of this device: simulation::MakeTickOptions.
 @param is_live  As in device::OpenAnyDevice. @pre the device is open. */
[[nodiscard]] Hand MakeDeviceHand(const simulation::Model& model, device::OpenedDevice opened,
                                  const haptics::TickOptions& tick, std::uint64_t seed,
                                  bool is_live);

/** What is asked for of one hand. */
struct HandOptions {
  std::string device;  ///< An address as device::OpenAnyDevice takes it; empty: none.
  simulation::RenderOptions render;
  std::uint64_t seed{1};  ///< The simulated person's.
  bool is_live{false};    ///< Runs in real time; no real device works without it.
};

/** Opens the device, where one is asked for, and makes the hand that holds it, else the hand of a
 simulated person. Errors: those of device::OpenAnyDevice. */
[[nodiscard]] Result<Hand> MakeHand(const simulation::Model& model, const HandOptions& options);

/** How a device is told of. */
struct DeviceInHand {
  std::size_t hand{0};
  std::string address;  ///< What was asked for.
  std::string model;
  std::string profile;  ///< Id of the one that it is rendered by; may be empty.
  bool is_emulated{false};
  std::vector<std::string> notes;  ///< How it is rendered to, one sentence each.
};

/** The devices in these hands, by hand; hands without one are left out. */
[[nodiscard]] std::vector<DeviceInHand> DescribeDevices(const std::vector<Hand>& hands);

}  // namespace hvas::assembly
