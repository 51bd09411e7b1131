#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "base/clock.h"

namespace hvas {

/** A clock by which the threads of a live session wait for their deadlines. Any thread may call any
 function. */
class LoopClock : public Clock {
 public:
  /** Waits until a time [ns], or until `is_over` holds, which is asked under a lock of the clock at
   the beginning and after each WakeAll(). RT-safe with the machine's clock, which does not ask. */
  virtual void WaitUntil(std::int64_t t_ns, const std::function<bool()>& is_over) noexcept = 0;

  /** Counts a thread that is going to wait by this clock: steered time does not pass while one of
   them computes. */
  virtual void Enter() noexcept = 0;

  /** Ends what Enter() began. */
  virtual void Leave() noexcept = 0;

  /** Lets all that wait ask whether it is over. */
  virtual void WakeAll() noexcept = 0;

  /** Whether time waits for the threads, so that no deadline is ever missed. */
  [[nodiscard]] virtual bool is_steered() const noexcept = 0;
};

/** The machine's clock (SystemClock), which waits for nobody. */
[[nodiscard]] LoopClock& MachineClock() noexcept;

/** Time that its owner lets go on, and that waits for all threads that entered: it moves from
 deadline to deadline, each time after all of them wait again. A busy machine makes it slow, and
 nothing late. */
class SteeredClock final : public LoopClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override { return now_ns_.load(); }

  /** Lets so much time pass [ns]. @returns when it has passed and all threads wait again. For one
   thread, which has not entered. */
  void Advance(std::int64_t step_ns) noexcept;

  void WaitUntil(std::int64_t t_ns, const std::function<bool()>& is_over) noexcept override;
  void Enter() noexcept override;
  void Leave() noexcept override;
  void WakeAll() noexcept override;

  [[nodiscard]] bool is_steered() const noexcept override { return true; }

  /** Whether any thread has entered. */
  [[nodiscard]] bool has_threads() const noexcept;

 private:
  /** A thread that waits. */
  struct Waiter {
    std::int64_t t_ns;
    const std::function<bool()>* is_over;
    bool is_released{false};
    std::condition_variable released;
  };

  /** Moves time on as far as it may go now. @pre mutex_ is locked. */
  void MoveOn();
  /** Lets those go on for which `holds`. @pre mutex_ is locked. */
  void Release(const std::function<bool(const Waiter&)>& holds);

  [[nodiscard]] bool do_all_wait() const { return waiters_.size() == entered_; }

  // Not 0, which is no time in many records. Written under the mutex.
  std::atomic<std::int64_t> now_ns_{kNsPerSecond};
  mutable std::mutex mutex_;  ///< Protects what follows.
  std::condition_variable arrived_;
  std::vector<Waiter*> waiters_;
  std::size_t entered_{0};
  std::int64_t end_ns_{kNsPerSecond};  ///< Time may go on until then.
};

/** Lets a steered clock go on while this object lives, on a thread of its own. */
class ClockDriver {
 public:
  /** @param pace  Called before each step; waits as long as the clock is to stand still. Null: time
   passes as fast as the threads compute. */
  explicit ClockDriver(SteeredClock* clock, std::function<void(const std::stop_token&)> pace = {});
  ~ClockDriver();
  ClockDriver(const ClockDriver&) = delete;
  ClockDriver& operator=(const ClockDriver&) = delete;

  /** Time of one step [ns]: a choice; below the period of frames, and of the inputs of a page. */
  static constexpr std::int64_t kStepNs = 4'000'000;

 private:
  std::jthread thread_;
};

}  // namespace hvas
