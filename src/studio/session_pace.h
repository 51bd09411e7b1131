#pragma once

#include <cstdint>
#include <stop_token>

#include "studio/live_scene.h"

namespace hvas::studio {

/** How fast a steered clock goes on for a session (ClockDriver): no faster than the wall clock
 while the user works, and as fast as the loops compute while the simulated person does. It waits
 for the browser in whose hand a part is, so that neither a slow machine nor a slow page makes the
 force pause; only a page that is silent for kPatienceNs of the wall clock does. */
class SessionPace {
 public:
  /** Session time that may pass without an input [ns]: below PointerOperator::kInputTimeoutNs. */
  static constexpr std::int64_t kLeadNs = 100'000'000;
  /** Time on the wall clock after which a page is silent [ns]: a choice, far above what a busy
   machine takes to draw one picture of a page. */
  static constexpr std::int64_t kPatienceNs = 5'000'000'000;

  explicit SessionPace(const LiveScene* live) : live_(live) {}

  /** Returns when a step may begin, or when a stop is requested. */
  void operator()(const std::stop_token& stop);

 private:
  /** Whether the page in whose hand a part is may still send an input. */
  [[nodiscard]] bool AwaitsInput();

  const LiveScene* live_;
  std::int64_t next_ns_{0};     ///< MonotonicNs() at which the next step may begin.
  std::int64_t awaited_ns_{0};  ///< Session time of the input after which another one is awaited.
  std::int64_t since_ns_{0};    ///< MonotonicNs() since when.
};

}  // namespace hvas::studio
