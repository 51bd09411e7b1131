#pragma once

#include <string>
#include <vector>

#include "device/device.h"
#include "haptics/options.h"
#include "simulation/model.h"
#include "simulation/operator.h"

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

}  // namespace hvas::simulation
