#pragma once

#include <array>
#include <string>
#include <vector>

#include "device/device.h"
#include "device/emulation/emulator.h"
#include "haptics/options.h"
#include "simulation/model.h"
#include "simulation/operator.h"
#include "simulation/simulated_person.h"

namespace hvas::simulation {

/** What a person may choose about how a model is rendered to a device. */
struct RenderOptions {
  double scale{0};       ///< Scene length per device length; 0: chosen from the sizes of both.
  double rate_hz{1000};  ///< Rate of the haptic tick, 1000..8000 [Hz].
};

/** Options of the tick for a model and a device: coupling by the device's limits and the rate, full
 safety limits, passivity control, the handle's workspace around the product. A device that shows no
 forces is rendered to as the simulated one would be, and given nothing. */
[[nodiscard]] haptics::TickOptions MakeTickOptions(const device::DeviceInfo& info,
                                                   const Model& model, const RenderOptions& render);

/** The habits of a person with a device: presses nearly as hard as it can push back, and notices
 when the hand goes further than a part that does not follow can be stretched from it. */
[[nodiscard]] PersonOptions MakePersonOptions(const haptics::TickOptions& options);

/** What a person should know about how this device is rendered to; one sentence each. */
[[nodiscard]] std::vector<std::string> DescribeRendering(const device::DeviceInfo& info,
                                                         const haptics::TickOptions& options);

/** A sample with the time at which the device took it. RT-safe as far as the device is. */
[[nodiscard]] device::DeviceState ReadDevice(device::Device* device) noexcept;

/** A device as the operator. RT-safe as far as the device is. */
class DeviceOperator final : public Operator {
 public:
  explicit DeviceOperator(device::Device* device) : device_(device) {}

  device::DeviceState Step(const OperatorInput& input) noexcept override {
    (void)input;
    return ReadDevice(device_);
  }

  void Apply(const spatial::Wrench& F_H_D) noexcept override { device_->Write(F_H_D); }

 private:
  device::Device* device_;
};

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
class PersonAtDevice final : public Operator {
 public:
  PersonAtDevice(DeviceHolder* person, device::Emulator* emulator, device::Device* device,
                 bool is_live)
      : person_(person), emulator_(emulator), device_(device), is_live_(is_live) {}

  device::DeviceState Step(const OperatorInput& input) noexcept override;

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

}  // namespace hvas::simulation
