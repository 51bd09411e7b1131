#pragma once

#include <cstdint>
#include <limits>

#include "spatial/pose.h"

namespace hvas::haptics {

/** Watches the time from one write to a device to the next, by the clock of the loop that writes:
 of a session's tick and of a trial alike. The gate starts anew after a gap, and what it let through
 before one is not written after it: a thread can be kept waiting between the two. RT-safe. */
class WritePace {
 public:
  /** Time since the last write where the device does not show what the gate let through last. */
  static constexpr std::int64_t kUnknownNs = std::numeric_limits<std::int64_t>::max();

  /** A tick is about to ask the gate. Returns the time since the last write, for the gate [ns]: 0
   before the first one, kUnknownNs where the last wrench was withheld, negative where the clock
   went back. */
  [[nodiscard]] std::int64_t Begin(std::int64_t now_ns) noexcept;

  /** Returns what may be written now of the wrench that the gate has let through since Begin():
   nothing where the device went without a write for too long meanwhile. */
  [[nodiscard]] spatial::Wrench Admit(const spatial::Wrench& F_H_D, std::int64_t now_ns) noexcept;

 private:
  [[nodiscard]] std::int64_t CalcGap(std::int64_t now_ns) const noexcept;

  std::int64_t written_ns_{0};
  std::int64_t begun_ns_{0};
  bool has_written_{false};
  bool has_withheld_{false};
  bool starts_anew_{false};  ///< The gate knows of the gap before this tick.
};

}  // namespace hvas::haptics
