#pragma once

#include <array>

#include "device/device.h"
#include "device/emulation/emulator.h"
#include "haptics/options.h"
#include "person/simulated_person.h"
#include "simulation/device_session.h"

namespace hvas::person {

/** The habits of a person with a device: presses nearly as hard as it can push back, and notices
 when the hand goes further than a part that does not follow can be stretched from it. */
[[nodiscard]] PersonOptions MakePersonOptions(const haptics::TickOptions& options);

/** A wish that reaches the hand as muscles build up their force: within some ten milliseconds, and
 without a jerk. */
class Muscles {
 public:
  /** What has become of what is wanted; `rate` is how fast it changes. */
  const Vec3& Follow(const Vec3& wanted, double dt, Vec3* rate) noexcept;

 private:
  std::array<Vec3, 3> stages_{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/** A person, simulated or at a page far away, with an emulated device in the hand: what the person
 wants becomes the impedance of the emulated hand, and all else goes through the device's driver, as
 with a real one. Not RT-safe: the emulator is not. */
class PersonAtDevice final : public simulation::Operator {
 public:
  PersonAtDevice(DeviceHolder* person, device::Emulator* emulator, device::Device* device,
                 bool is_live)
      : person_(person), emulator_(emulator), device_(device), is_live_(is_live) {}

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override;

  void Apply(const spatial::Wrench& F_H_D) noexcept override { device_->Write(F_H_D); }

 private:
  /** Where the hand goes to, and the force of what it wants beyond its device's room. */
  void Reach(const Vec3& p_DR, const Vec3& p_DH, double dt, device::HandIntent* hand) noexcept;

  DeviceHolder* person_;
  device::Emulator* emulator_;
  device::Device* device_;
  bool is_live_;  ///< The emulator moves its time on by itself.
  Muscles place_;
  Muscles beyond_;
};

}  // namespace hvas::person
