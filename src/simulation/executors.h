#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/histogram.h"
#include "simulation/operator.h"
#include "simulation/simulation.h"

namespace hvas::simulation {

/** What an executor measured. Times of compute are thread CPU times; wake-up is apart, because the
 host may steal either. */
struct ExecutionReport {
  std::int64_t session_ns{0};  ///< Session time that was run.
  std::int64_t wall_ns{0};
  std::uint64_t ticks{0};
  LatencyHistogram compute;        ///< Of a haptic tick, its operator excluded.
  LatencyHistogram wake_up;        ///< Realtime only: from deadline to start.
  std::uint64_t late_wake_ups{0};  ///< Started more than a period after the deadline.
  std::uint64_t overruns{0};       ///< Compute alone took longer than a period.
  std::string scheduling;          ///< What the system granted, in words.
};

/** Runs the loops of a simulation until `is_done` says so or `limit_ns` of session time have
 passed. `advance` runs after every physics step, on its thread. */
struct Execution {
  Simulation* simulation{nullptr};
  Operator* hand{nullptr};
  Sink* sink{nullptr};
  std::function<void()> advance;
  std::function<bool()> is_done;
  std::int64_t limit_ns{0};
};

/** Virtual time on the calling thread: bit for bit repeatable, faster than real time. */
ExecutionReport RunLockstep(const Execution& execution);

/** Three threads at the rates of X4: haptic 1 kHz with real-time priority where the system grants
 it, physics 100 Hz, publishing 30 Hz. */
ExecutionReport RunRealtime(const Execution& execution);

}  // namespace hvas::simulation
