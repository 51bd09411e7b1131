#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "base/result.h"
#include "studio/json.h"
#include "studio/live_hand.h"

namespace hvas::studio {

/** Devices of the hands; they stay open from one live run to the next. Any thread may call it, but
 Use(), which may take some seconds, is for one thread. */
class HandRack {
 public:
  static constexpr const char* kPointer = "pointer";  ///< Address for a hand without a device.
  static constexpr std::size_t kMaxHands = haptics::kMaxHands;  ///< The tick's own limit.

  [[nodiscard]] std::size_t count() const;

  /** Sets the number of hands; closes the devices of hands that are removed. @pre 1 to kMaxHands.
   */
  void SetCount(std::size_t count);

  /** Assigns a device to a hand in place of its present one; a device that it has already stays
   open.
   @param scale  As in simulation::RenderOptions.
   @param is_live  As in device::OpenAnyDevice; the same in every call.
   Errors: kInvalid where there is no such hand or another hand has the device; the driver's. */
  [[nodiscard]] Result<void> Use(std::size_t hand, const std::string& address, double scale,
                                 bool is_live);

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
    std::string address{kPointer};
    HandSetup setup;
    device::Condition condition{device::Condition::kReady};
  };

  mutable std::mutex mutex_;
  std::vector<Slot> slots_{1};
};

/** Searches for devices that a hand could use, without opening one. Any thread may call it. */
class DeviceSearch {
 public:
  /** Claims the search. @returns whether the caller has to call Run(): false while one is
   running. */
  [[nodiscard]] bool Begin();

  /** Searches; takes some seconds. */
  void Run();

  /** Makes the field "devices" of docs/protocol.md, from the result of the last search. */
  [[nodiscard]] Json Describe() const;

 private:
  mutable std::mutex mutex_;
  Json found_ = Json::array();
  bool is_searching_{false};
};

}  // namespace hvas::studio
