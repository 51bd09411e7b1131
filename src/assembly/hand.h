#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "device/opened_device.h"
#include "haptics/options.h"
#include "person/simulated_person.h"
#include "simulation/device_session.h"
#include "simulation/model.h"
#include "simulation/operator.h"

namespace hvas::assembly {

/** What moves one hand of a run: a guided hand; a simulated person, alone or with an emulated
 device in the hand; or the user of a real device. */
struct Hand {
  std::string address;          ///< Address of the device, as requested; empty: none.
  device::OpenedDevice opened;  ///< Empty without a device.
  haptics::TickOptions tick;
  std::unique_ptr<simulation::TaskOperator> mover;  ///< Null where the user of a device has it.
  std::unique_ptr<simulation::Operator> at_device;  ///< Null without a device.

  /** Operator of this hand; never null in a hand that one of the functions below has made. */
  [[nodiscard]] simulation::Operator* active() const {
    return at_device != nullptr ? at_device.get() : mover.get();
  }
};

/** Makes the options of the tick for a simulated person without a device: those of a device of six
 degrees of freedom whose forces have no limits. */
[[nodiscard]] haptics::TickOptions MakePersonTick(const simulation::RenderOptions& render);

/** Makes the hand of a simulated person without a device. The same habits and seed give the same
 hand. */
[[nodiscard]] Hand MakePersonHand(const simulation::Model& model, const haptics::TickOptions& tick,
                                  const person::PersonOptions& habits, std::uint64_t seed);

/** Makes a hand that holds a device. A simulated person with this seed holds an emulated one, the
 user a real one.
 @param tick  Options for this device, from simulation::MakeTickOptions.
 @param is_live  As in device::OpenAnyDevice. @pre the device is open. */
[[nodiscard]] Hand MakeDeviceHand(const simulation::Model& model, device::OpenedDevice opened,
                                  const haptics::TickOptions& tick, std::uint64_t seed,
                                  bool is_live);

/** Makes the hand that follows planned ways (simulation::GuidedHand), with the options of its tick:
 a coupling as stiff as a firm grip, through which it can press with kMostHandForce. */
[[nodiscard]] Hand MakeGuidedHand(const simulation::Model& model,
                                  const simulation::RenderOptions& render);

/** Options of one hand. */
struct HandOptions {
  std::string device;  ///< An address as device::OpenAnyDevice takes it; empty: none.
  simulation::RenderOptions render;
  std::uint64_t seed{1};  ///< Seed of the simulated person.
  bool is_live{false};    ///< Runs in real time; no real device works without it.
  /** How a simulated person without a device works; none: a guided hand. */
  std::optional<person::PersonKind> person;
};

/** Opens the device, where one is asked for, and makes the hand that holds it, else a guided hand
 or the hand of a simulated person. Errors: those of device::OpenAnyDevice. */
[[nodiscard]] Result<Hand> MakeHand(const simulation::Model& model, const HandOptions& options);

/** Description of a device in a hand, for people. */
struct DeviceInHand {
  std::size_t hand{0};
  std::string address;  ///< Address as requested.
  std::string model;
  std::string profile;  ///< Id of its profile; may be empty.
  bool is_emulated{false};
  std::vector<std::string> notes;  ///< Sentences on how forces are rendered with it.
};

/** Describes the devices in these hands, in their order; hands without one are omitted. */
[[nodiscard]] std::vector<DeviceInHand> DescribeDevices(const std::vector<Hand>& hands);

}  // namespace hvas::assembly
