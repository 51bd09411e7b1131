#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "haptics/options.h"

namespace hvas::simulation {

/** What is left out when ticks take too long, level by level: first sample points of contacts, then
 also iterations of the solver, last the motion of loose parts that are touched. */
inline constexpr std::array<haptics::Effort, 4> kEffortLevels{
    haptics::Effort{},
    haptics::Effort{1024, 30, true},
    haptics::Effort{512, 15, true},
    haptics::Effort{256, 10, false},
};

/** Chooses the level long before a deadline is missed (X4): one up as soon as a tick takes more
 than it should, 200 us or half of its period; one down when for half a second none took more than
 half of that. RT-safe. */
class LoadShedder {
 public:
  explicit LoadShedder(std::int64_t period_ns)
      : period_ns_(period_ns), longest_ns_(std::min(kLongestNs, period_ns / 2)) {}

  /** @param compute_ns  Of the tick that just ended. @returns  The level of the next one. */
  int Update(std::int64_t compute_ns) noexcept {
    since_change_ns_ += period_ns_;
    if (compute_ns > longest_ns_ / 2) {
      quiet_ns_ = 0;
    } else {
      quiet_ns_ += period_ns_;
    }
    constexpr int kHighest = static_cast<int>(kEffortLevels.size()) - 1;  ///< The last level.
    if (compute_ns > longest_ns_ && level_ < kHighest && since_change_ns_ >= kSettleNs) {
      ++level_;
      since_change_ns_ = 0;
    } else if (quiet_ns_ >= kQuietNs && level_ > 0) {
      --level_;
      since_change_ns_ = 0;
      quiet_ns_ = 0;
    }
    return level_;
  }

  [[nodiscard]] int level() const noexcept { return level_; }

 private:
  static constexpr std::int64_t kLongestNs = 200'000;   // that a tick should take
  static constexpr std::int64_t kSettleNs = 3'000'000;  // until a change shows
  /** Quiet time until more is done again: a choice. */
  static constexpr std::int64_t kQuietNs = 500'000'000;

  std::int64_t period_ns_;
  std::int64_t longest_ns_;
  std::int64_t since_change_ns_{kSettleNs};
  std::int64_t quiet_ns_{0};
  int level_{0};
};

}  // namespace hvas::simulation
