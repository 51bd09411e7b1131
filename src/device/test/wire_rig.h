#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "device/drivers/wire_drivers.h"
#include "device/emulation/wire_emulator.h"
#include "device/test/tick_time.h"

namespace hvas::device::testing {

/** A driver and its emulator in virtual time, at 1 kHz. */
class WireRig {
 public:
  WireRig(const Driver& driver, const EmulatorOptions& options, MakeWireServer make = nullptr) {
    auto emulator = make != nullptr ? StartWireEmulator(make, options)
                                    : StartWireEmulator(driver.name(), options);
    EXPECT_TRUE(emulator) << emulator.error().ToString();
    if (emulator) {
      emulator_ = std::move(*emulator);
      Open(driver);
    }
  }

  void Open(const Driver& driver) {
    const std::string address = emulator_->address();
    const std::size_t colon = address.find(':');
    EXPECT_EQ(address.substr(0, colon), driver.name());
    auto device = driver.Open(address.substr(colon + 1), emulator_->surroundings());
    EXPECT_TRUE(device) << device.error().ToString();
    device_ = device ? std::move(*device) : nullptr;
  }

  void Close() { device_.reset(); }

  [[nodiscard]] bool is_open() const { return device_ != nullptr; }

  Device& device() { return *device_; }

  Emulator& emulator() { return *emulator_; }

  EmulatedDevice& hardware() { return emulator_->device(); }

  [[nodiscard]] EmulatedDevice::Truth truth() const { return emulator_->device().truth(); }

  DeviceState Read() {
    emulator_->Advance(kTickNs);
    return device_->Read();
  }

  /** Ticks with a constant wrench, whatever the device says; the last state. */
  DeviceState Run(int ticks, const spatial::Wrench& F_H_D = {}) {
    DeviceState state;
    for (int i = 0; i < ticks; ++i) {
      state = Read();
      device_->Write(F_H_D);
    }
    return state;
  }

  /** Ticks until it is ready, at most so many; how many there were. */
  int RunUntilReady(int limit, const spatial::Wrench& F_H_D = {}) {
    for (int i = 1; i <= limit; ++i) {
      if (Run(1, F_H_D).condition == Condition::kReady) {
        return i;
      }
    }
    return limit + 1;
  }

 private:
  std::unique_ptr<Emulator> emulator_;
  std::unique_ptr<Device> device_;
};

/** An emulator's options with a profile that HVAS knows. */
inline EmulatorOptions OptionsOf(const std::string& profile) {
  EmulatorOptions options;
  options.profile = FindProfile(profile)->profile;
  return options;
}

inline spatial::Wrench Push(double force) {
  spatial::Wrench F;
  F.f.x() = force;
  return F;
}

}  // namespace hvas::device::testing
