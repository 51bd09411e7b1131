#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "studio/live_hand.h"

namespace hvas::studio {

/** The devices that are in the hands, from one live run to the next. Any thread; Use may take some
 seconds, and is one thread's. */
class HandRack {
 public:
  static constexpr const char* kPointer = "pointer";  ///< The address of no device.
  static constexpr std::size_t kMostHands = 2;

  [[nodiscard]] std::size_t count() const;

  /** What a hand that is taken away has held is closed. @pre 1 or kMostHands. */
  void SetCount(std::size_t count);

  /** Puts a device into a hand, in the place of what is there. One that is there already stays
   open. Errors: kInvalid where the hand is none or the device is in the other one; the driver's. */
  [[nodiscard]] Result<void> Use(std::size_t hand, const std::string& address, double scale);

  /** By hand. */
  [[nodiscard]] std::vector<HandSetup> setups() const;

  /** A tick has told how a device is. @returns that in words, with what to do; empty for none. */
  std::string SetState(std::size_t hand, device::Condition condition, std::int32_t vendor_code);

  /** "hands" of docs/protocol.md.
   @param hands  Those of the run, for what they render; may be empty. */
  [[nodiscard]] nlohmann::ordered_json Describe(
      const std::vector<const haptics::TickOptions*>& hands) const;

 private:
  struct Slot {
    std::string address{kPointer};
    HandSetup setup;
    device::Condition condition{device::Condition::kReady};
  };

  mutable std::mutex mutex_;
  std::vector<Slot> slots_{1};
};

/** What could be put into a hand, found without opening any. Any thread. */
class DeviceSearch {
 public:
  /** @returns whether the caller is to call Run: false where somebody searches already. */
  [[nodiscard]] bool Begin();

  /** Takes some seconds. */
  void Run();

  /** "devices" of docs/protocol.md: those found last. */
  [[nodiscard]] nlohmann::ordered_json Describe() const;

 private:
  mutable std::mutex mutex_;
  nlohmann::ordered_json found_ = nlohmann::ordered_json::array();
  bool is_searching_{false};
};

}  // namespace hvas::studio
