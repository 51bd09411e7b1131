#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/loop_clock.h"

namespace hvas::simulation {

/** What the system granted to a thread that asked for real-time treatment. */
struct RealtimeGrant {
  bool is_fifo{false};           ///< SCHED_FIFO, above all ordinary threads.
  bool is_memory_locked{false};  ///< No page of the process is ever fetched from disk again.
  int core{-1};                  ///< That it has to itself; -1: shares with others.
  std::string fifo_refusal;      ///< Why not; empty when granted.
  std::string memory_refusal;

  /** One line for a person. */
  [[nodiscard]] std::string ToString() const;
};

/** Asks for SCHED_FIFO, locked memory, and one of the cores that the system was told to keep free
 of other work (isolcpus), for the calling thread. What is refused is left as it was. */
[[nodiscard]] RealtimeGrant RequestRealtime();

/** While it lives, the calling thread goes before all ordinary ones and after the haptic thread,
 where the system grants that: for the physics loop, which the hand waits for when it takes a part.
 */
class PhysicsPriority {
 public:
  PhysicsPriority() noexcept;
  ~PhysicsPriority();
  PhysicsPriority(const PhysicsPriority&) = delete;
  PhysicsPriority& operator=(const PhysicsPriority&) = delete;

 private:
  int policy_before_{0};
  int priority_before_{0};
};

/** Gives locked memory back. */
void ReleaseRealtime();

/** The first core of a list as Linux writes it, as in "2-3,5"; -1 where there is none. */
[[nodiscard]] int FirstCoreOf(const std::string& list);

/** Wakes a thread at a fixed rate. Deadlines are absolute, so there is no drift; after a stall
 those that were missed are passed over, so there is no burst. RT-safe with the machine's clock. */
class Pacer {
 public:
  explicit Pacer(std::int64_t period_ns, LoopClock* clock = &MachineClock()) noexcept;

  /** Sleeps until the next deadline, or until `is_over` holds (LoopClock::WaitUntil).
   @returns  How late it woke up [ns]. */
  std::int64_t Wait(const std::function<bool()>& is_over) noexcept;
  std::int64_t Wait() noexcept;

  /** Periods passed over so far. */
  [[nodiscard]] std::uint64_t missed() const noexcept { return missed_; }

 private:
  LoopClock* clock_;
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  std::uint64_t missed_{0};
};

}  // namespace hvas::simulation
