#pragma once

#include <array>
#include <cstdint>
#include <mutex>

#include "device/emulation/emulated_device.h"

/** What a library that stands in for a vendor's shares with the emulator behind it. */
namespace hvas::device {

/** How a device shows itself through the vendor's functions, besides what EmulatedDevice does. */
struct StubTraits {
  const char* model{""};    ///< What it calls itself; lives as long as the device.
  int system_type{0};       ///< Force Dimension's number of its type.
  bool has_gripper{false};  ///< It has a gripper, and functions for it.
  bool has_active_wrist{false};
  double max_force{-1};           ///< Limit that its software has set [N]; negative: none.
  double max_torque{-1};          ///< [N m]
  bool is_licensed{true};         ///< OpenHaptics has a licence.
  bool is_calibrated{true};       ///< Whether it is calibrated at first.
  bool can_calibrate{true};       ///< When asked to.
  bool is_of_this_version{true};  ///< Library and controller fit each other.
};

/** The one symbol that a stub has and a vendor's library has not: `hvas_emulator()`. */
struct StubEntry {
  /** Puts a device on; returns its number, or -1 when there are too many. */
  int (*attach)(EmulatedPort* port, const StubTraits& traits);
  /** Takes it off. To whoever has it open it is unplugged from then on. */
  void (*detach)(int number);
  /** What the vendor's own thread or controller does at some time of the emulator's clock. */
  void (*tick)(int number, std::int64_t now_ns);
};

using StubEntryFunction = const StubEntry*();

constexpr int kMaxStubDevices = 16;  // Drivers look for so many.

/** A device of a stub; a kind of stub adds what else its vendor's software remembers. */
struct StubSlot {
  EmulatedPort* port{nullptr};
  StubTraits traits;
  bool is_open{false};
  EmulatedSample sample;  ///< That the vendor's software saw last.

  [[nodiscard]] bool is_plugged() const {
    return port != nullptr && port->Sense().fault != Fault::kUnplugged;
  }

  [[nodiscard]] Fault fault() const {
    return port != nullptr ? port->Sense().fault : Fault::kUnplugged;
  }

  void Command(const spatial::Wrench& F) const {
    if (port != nullptr) {
      port->Command(F);
    }
  }
};

/** All devices of a stub. Whoever uses a slot holds the mutex. */
template <typename Slot>
class StubSlots {
 public:
  int Attach(EmulatedPort* port, const StubTraits& traits) {
    const std::scoped_lock lock(mutex_);
    for (int number = 0; number < kMaxStubDevices; ++number) {
      Slot& slot = slots_[static_cast<std::size_t>(number)];
      if (slot.port == nullptr && !slot.is_open) {
        slot = Slot();
        slot.port = port;
        slot.traits = traits;
        slot.sample = port->Sense();
        return number;
      }
    }
    return -1;
  }

  void Detach(int number) {
    const std::scoped_lock lock(mutex_);
    slots_[static_cast<std::size_t>(number)].port = nullptr;
  }

  /** Null for a number that no device has. */
  Slot* Find(int number) {
    const bool is_number = number >= 0 && number < kMaxStubDevices;
    return is_number ? &slots_[static_cast<std::size_t>(number)] : nullptr;
  }

  std::array<Slot, kMaxStubDevices>& slots() { return slots_; }

  std::recursive_mutex& mutex() { return mutex_; }

 private:
  std::recursive_mutex mutex_;  // Callbacks of a scheduler call back in.
  std::array<Slot, kMaxStubDevices> slots_;
};

}  // namespace hvas::device
