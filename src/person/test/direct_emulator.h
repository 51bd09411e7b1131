#pragma once

#include <string>

#include "base/clock.h"
#include "device/emulation/emulator.h"
#include "device/sample_guard.h"

namespace hvas::person::testing {

/** An emulated device without any vendor's interface in between: what a driver could be at best. */
class DirectEmulator final : public device::Emulator {
 public:
  explicit DirectEmulator(const device::DeviceProfile& profile) : device_(profile) {}

  device::EmulatedDevice& device() override { return device_; }

  [[nodiscard]] const device::Surroundings& surroundings() const override { return surroundings_; }

  [[nodiscard]] std::string address() const override { return "direct"; }

  void Advance(std::int64_t step_ns) override { device_.Advance(step_ns); }

 private:
  device::EmulatedDevice device_;
  device::Surroundings surroundings_;
};

class DirectDevice final : public device::Device {
 public:
  explicit DirectDevice(device::EmulatedDevice* emulated)
      : emulated_(emulated),
        guard_(emulated->profile().position_resolution, emulated->profile().rotation_resolution) {
    info_.driver = "direct";
    info_.is_emulated = true;
    info_.profile = emulated->profile();
    info_.capabilities.force_axes = info_.profile.max_force > 0 ? 3 : 0;
    info_.capabilities.torque_axes = info_.profile.max_torque > 0 ? 3 : 0;
    info_.capabilities.senses_rotation = true;
  }

  [[nodiscard]] const device::DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] device::DeviceState Read() noexcept override {
    const device::EmulatedSample sample = emulated_->Sense();
    const std::int64_t now_ns = emulated_->truth().t_ns;
    if (sample.sequence == sequence_) {
      return state_ = guard_.Repeat(now_ns);
    }
    sequence_ = sample.sequence;
    device::DeviceState state;
    state.t_ns = sample.t_ns;
    state.X_DH = sample.X_DH;
    state.V_DH = sample.V_DH;
    state.buttons = sample.buttons;
    state.condition = Judge(sample);
    return state_ = guard_.Accept(state);
  }

  void Write(const spatial::Wrench& F_H_D) noexcept override {
    emulated_->Command(state_.condition == device::Condition::kReady ? F_H_D : spatial::Wrench());
  }

 private:
  static device::Condition Judge(const device::EmulatedSample& sample) noexcept {
    if (sample.is_stopped) {
      return device::Condition::kStopped;
    }
    if (sample.fault == device::Fault::kCalibrationLost) {
      return device::Condition::kNotCalibrated;
    }
    if (sample.fault == device::Fault::kForceRefused) {
      return device::Condition::kNoForce;
    }
    return sample.is_holding ? device::Condition::kReady : device::Condition::kNotHeld;
  }

  device::EmulatedDevice* emulated_;
  device::SampleGuard guard_;
  device::DeviceInfo info_;
  device::DeviceState state_;
  std::uint64_t sequence_{0};
};

}  // namespace hvas::person::testing
