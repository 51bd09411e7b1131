#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"
#include "device/driver.h"
#include "studio/json.h"
#include "studio/live_hand.h"

namespace hvas::studio {

/** The devices that a hand can have: the pointer, those that the host has named when the program
 was started, the drivers, and the emulated ones, in this order, which is the same until the program
 ends. A page names a device by its index here, never by an address. */
class DeviceList {
 public:
  static constexpr std::size_t kPointer = 0;  ///< Index for a hand without a device.

  /** @param named  Addresses of the host's, as device::OpenAnyDevice takes them. */
  explicit DeviceList(const std::vector<std::string>& named = {});

  struct Entry {
    std::string address;
    std::string driver;
    std::string name;  ///< Title for people, without an address.
    bool is_emulated{false};
    const device::Driver* probed{nullptr};  ///< Looks whether it is there; null: nobody does.
  };

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

/** Devices of the hands; they stay open from one live run to the next. Any thread may call it, but
 Use(), which may take some seconds, is for one thread. */
class HandRack {
 public:
  static constexpr std::size_t kMaxHands = haptics::kMaxHands;  ///< The tick's own limit.

  /** @param list  Outlives this. */
  explicit HandRack(const DeviceList* list) : list_(list) {}

  [[nodiscard]] std::size_t count() const;

  /** Sets the number of hands; closes the devices of hands that are removed. @pre 1 to kMaxHands.
   */
  void SetCount(std::size_t count);

  /** Assigns a device to a hand in place of its present one; a device that it has already stays
   open.
   @param scale  As in simulation::RenderOptions.
   @param is_live  As in device::OpenAnyDevice; the same in every call.
   Errors: kInvalid where there is no such hand or another hand has the device; the driver's.
   @pre the list has the device. */
  [[nodiscard]] Result<void> Use(std::size_t hand, std::size_t device, double scale, bool is_live);

  /** Setups, indexed by hand. */
  [[nodiscard]] std::vector<HandSetup> setups() const;

  /** Keeps the condition of a device that a tick has reported. @returns a message for people, with
   the remedy; empty where there is none to show. */
  std::string SetState(std::size_t hand, device::Condition condition, std::int32_t vendor_code);

  /** Makes the field "hands" of docs/protocol.md.
   @param hands  Tick options of the run, for what the hands render; may be empty. */
  [[nodiscard]] Json Describe(const std::vector<const haptics::TickOptions*>& hands) const;

 private:
  struct Slot {
    std::size_t device{DeviceList::kPointer};
    HandSetup setup;
    device::Condition condition{device::Condition::kReady};
  };

  const DeviceList* const list_;
  mutable std::mutex mutex_;
  std::vector<Slot> slots_{1};
};

/** Searches for devices that a hand could use, without opening one. Any thread may call it. */
class DeviceSearch {
 public:
  /** @param list  Outlives this. */
  explicit DeviceSearch(const DeviceList* list) : list_(list) {}

  /** Claims the search. @returns whether the caller has to call Run(): false while one is
   running. */
  [[nodiscard]] bool Begin();

  /** Searches; takes some seconds. */
  void Run();

  /** Makes the field "devices" of docs/protocol.md, from the result of the last search. */
  [[nodiscard]] Json Describe() const;

 private:
  const DeviceList* const list_;
  mutable std::mutex mutex_;
  Json found_ = Json::array();
  bool is_searching_{false};
};

}  // namespace hvas::studio
