#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "device/drivers/vendor_drivers.h"
#include "device/emulation/library_emulator.h"
#include "device/test/tick_time.h"

namespace hvas::device::testing {

/** A driver, and the device that its emulator shows. */
struct LibraryCase {
  const char* name;
  const Driver& (*driver)();
  const char* profile;
  int start_ms;  ///< Time until a device that was opened, or refused force, gives force again.
};

inline const LibraryCase kOpenHaptics{"openhaptics", OpenHapticsDriver, "touch_x", 400};
inline const LibraryCase kForceDimension{"forcedimension", ForceDimensionDriver, "sigma7", 400};
inline const LibraryCase kVirtuose{"virtuose", VirtuoseDriver, "virtuose", 3400};

inline DeviceProfile ProfileNamed(const char* id) {
  return FindProfile(id)->profile;
}

inline std::unique_ptr<Emulator> StartCase(const LibraryCase& which, const EmulatorOptions& options,
                                           const LibraryManners& manners = {}) {
  auto emulator = StartLibraryEmulator(which.name, options, manners);
  EXPECT_TRUE(emulator.has_value()) << emulator.error().ToString();
  return emulator ? std::move(*emulator) : nullptr;
}

/** Opens an emulator's device by its address, as a user would. */
inline Result<std::unique_ptr<Device>> OpenEmulated(const LibraryCase& which,
                                                    const Emulator& emulator) {
  const std::string address = emulator.address();
  return which.driver().Open(address.substr(address.find(':') + 1), emulator.surroundings());
}

using Law = std::function<spatial::Wrench(const DeviceState&)>;

/** A haptic loop at 1 kHz around one emulated device. */
class Rig {
 public:
  explicit Rig(const LibraryCase& which, DeviceProfile profile, const spatial::Pose& X_DH = {},
               const LibraryManners& manners = {}) {
    EmulatorOptions options;
    options.profile = std::move(profile);
    options.X_DH = X_DH;
    emulator_ = StartCase(which, options, manners);
    HandIntent hand;
    hand.X_DR = X_DH;
    emulator_->device().SetHand(hand);
    auto device = OpenEmulated(which, *emulator_);
    EXPECT_TRUE(device.has_value()) << device.error().ToString();
    if (device) {
      device_ = std::move(*device);
    }
  }

  DeviceState Tick(const Law& law = nullptr) {
    emulator_->Advance(kTickNs);
    DeviceState state = device_->Read();
    device_->Write(law != nullptr ? law(state) : spatial::Wrench());
    return state;
  }

  DeviceState Run(int ms, const Law& law = nullptr) {
    DeviceState state;
    for (int k = 0; k < ms; ++k) {
      state = Tick(law);
    }
    return state;
  }

  Emulator& emulator() { return *emulator_; }

  EmulatedDevice& emulated() { return emulator_->device(); }

  Device& device() { return *device_; }

  void Close() { device_.reset(); }

  void SetHand(const HandIntent& hand) { emulated().SetHand(hand); }

 private:
  std::unique_ptr<Emulator> emulator_;
  std::unique_ptr<Device> device_;
};

/** A wall at x = 0 that is pressed from its free side, x > 0. */
inline Law Wall(double stiffness, double damping) {
  return [=](const DeviceState& state) {
    spatial::Wrench F;
    const double x = state.X_DH.p().x();
    if (state.is_valid && x < 0) {
      F.f.x() = std::max(0.0, -stiffness * x - damping * state.V_DH.v.x());
    }
    return F;
  };
}

/** A hand that presses the wall with a force of so many newtons, when it gives way by F / k. */
inline HandIntent PressingHand(double force, double wall_stiffness) {
  HandIntent hand;
  hand.X_DR = spatial::Pose(Vec3(-force / wall_stiffness - force / hand.stiffness, 0, 0));
  return hand;
}

inline DeviceProfile WithoutFriction(DeviceProfile profile) {
  profile.friction = 0;
  profile.rotational_friction = 0;
  return profile;
}

}  // namespace hvas::device::testing
