#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/histogram.h"
#include "base/loop_clock.h"
#include "base/triple_buffer.h"
#include "simulation/flight_recorder.h"
#include "simulation/load_shedder.h"
#include "simulation/operator.h"
#include "simulation/realtime_thread.h"
#include "simulation/simulation.h"

namespace hvas::simulation {

/** A tick that took long, and what it had to do. */
struct SlowTick {
  std::int64_t t_ns{0};
  std::size_t hand{0};
  std::int64_t compute_ns{0};
  product::OccurrenceId occurrence;
  haptics::HoldState state{haptics::HoldState::kEmpty};
  std::uint32_t points_tested{0};  ///< Points tested by its contact queries.
  int contact_count{0};            ///< Contacts that pressed.
};

/** The slowest ticks of a run, the slowest first. RT-safe. */
class SlowTicks {
 public:
  void Add(const SlowTick& tick) noexcept;

  [[nodiscard]] const SlowTick* begin() const noexcept { return ticks_.data(); }

  [[nodiscard]] const SlowTick* end() const noexcept { return ticks_.data() + count_; }

 private:
  std::array<SlowTick, 8> ticks_;
  std::size_t count_{0};
};

/** Counts of the ticks of a hand in which the room for contact did not suffice (docs/limits.md). */
struct ContactLimits {
  std::uint64_t truncated_ticks{0};  ///< Ticks with haptics::ContactAccount::is_truncated.
  std::uint64_t crowded_ticks{0};    ///< Ticks with haptics::ContactAccount::is_crowded.

  /** Counts a tick. RT-safe. */
  void Add(const haptics::ContactAccount& account) noexcept {
    truncated_ticks += account.is_truncated ? 1 : 0;
    crowded_ticks += account.is_crowded ? 1 : 0;
  }
};

/** What an executor measured. Times of compute are thread CPU times; wake-up is apart, because the
 host may steal either. */
struct ExecutionReport {
  std::int64_t session_ns{0};  ///< Session time that was run.
  std::int64_t wall_ns{0};
  std::int64_t cpu_ns{0};  ///< Lockstep only: processor time of the whole run.
  std::uint64_t ticks{0};
  LatencyHistogram compute;         ///< Time of the hands' ticks of a period, operators excluded.
  SlowTicks slowest;                ///< Slowest ticks by compute time.
  LatencyHistogram wake_up;         ///< Realtime only: from deadline to start.
  std::uint64_t late_wake_ups{0};   ///< Started more than a period after the deadline.
  std::uint64_t overruns{0};        ///< Compute alone took longer than a period.
  std::uint64_t missed_periods{0};  ///< Realtime only: passed over after a stall.
  std::uint64_t lost_events{0};     ///< Simulation::lost_events().
  ContactLimits contact_limits;     ///< Ticks of all hands in which contact was incomplete.
  LatencyHistogram frame_age;       ///< Realtime only: of what is published, in session time.
  /** Realtime only: ticks by what had to be left out (kEffortLevels). */
  std::array<std::uint64_t, kEffortLevels.size()> ticks_at_level{};
  RealtimeGrant grant;     ///< Realtime only.
  std::string scheduling;  ///< What the system granted, in words.
};

/** How the haptic loop fares while it runs: of the second that ended last. */
struct LoopStatus {
  LatencyHistogram compute;
  LatencyHistogram wake_up;
  std::uint64_t ticks{0};  ///< Ticks since the beginning.
  std::uint64_t late_wake_ups{0};
  std::uint64_t overruns{0};
  std::uint64_t lost_events{0};
  ContactLimits contact_limits;  ///< Ticks since the beginning.
  int effort_level{0};
  bool is_fifo{false};  ///< Thread runs under SCHED_FIFO (RealtimeGrant).
  bool is_memory_locked{false};
};

/** The operators, by hand; null beyond the hands of the simulation. */
using Operators = std::array<Operator*, haptics::kMaxHands>;

/** Runs the loops of a simulation until `is_done` says so or `limit_ns` of session time have
 passed. `advance` runs after every physics step, on its thread. */
struct Execution {
  Simulation* simulation{nullptr};
  Operators hands{};  ///< One for each hand of the simulation.
  Sink* sink{nullptr};
  std::function<void()> advance;
  std::function<bool()> is_done;
  std::int64_t limit_ns{0};
  FlightRecorder* flight{nullptr};              ///< May be null.
  TickLog* log{nullptr};                        ///< The one that the simulation keeps; may be null.
  std::function<void(const Frame&)> on_frame;   ///< Called on the publish thread; realtime only.
  std::int64_t frame_ns{Simulation::kFrameNs};  ///< Time between frames; realtime only.
  TripleBuffer<LoopStatus>* status{nullptr};    ///< Written once a second; realtime only.
  /** Lockstep only: the physics loop misses its step at a session time in nanoseconds, as a thread
   that the system keeps waiting; null: never. */
  std::function<bool(std::int64_t)> is_physics_late;
  bool sheds_load{true};  ///< Realtime only; not by a steered clock, by which nothing is late.
  /** Realtime only: clock by which the loops wait. A steered one ends a wait where `is_done` holds
   after LoopClock::WakeAll(); then `is_done` may be called by any thread that calls that. */
  LoopClock* clock{&MachineClock()};
  bool is_live{false};  ///< Set by the executor.
};

/** Virtual time on the calling thread, one tick at a time, for a caller who does something between
 the ticks. Each hundredth of a second the physics loop has its step. */
class Lockstep {
 public:
  /** Does the first step of physics, as the base is put in its fixture.
   @param execution  Its is_done may be null: then only the limit ends it. */
  explicit Lockstep(const Execution& execution);
  ~Lockstep();
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;

  /** One tick of every hand, and the step of physics that is due after it. */
  void Tick();

  [[nodiscard]] bool is_over() const;

  [[nodiscard]] std::int64_t t_ns() const;  ///< Session time.

  /** Writes out what the flight recorder has, and gives the report. */
  [[nodiscard]] ExecutionReport Finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/** Virtual time on the calling thread: bit for bit repeatable, faster than real time. */
ExecutionReport RunLockstep(const Execution& execution);

/** Three threads at the rates of X4: haptic 1 kHz and more with real-time priority where the system
 grants it, physics 100 Hz, publishing 30 Hz; by the machine's clock, or by a steered one.
 @pre the calling thread has entered a steered clock (LoopClock::Enter). */
ExecutionReport RunRealtime(const Execution& execution);

}  // namespace hvas::simulation
