#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>

namespace hvas {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;  // A definition.

/** Time on a POSIX clock [ns]. RT-safe. */
[[nodiscard]] inline std::int64_t ReadClock(clockid_t clock) noexcept {
  timespec time{};
  ::clock_gettime(clock, &time);
  return static_cast<std::int64_t>(time.tv_sec) * kNsPerSecond + time.tv_nsec;
}

/** Time since an arbitrary start, never set back [ns]. RT-safe. */
[[nodiscard]] inline std::int64_t MonotonicNs() noexcept {
  return ReadClock(CLOCK_MONOTONIC);
}

/** A clock that can be another one in tests and emulators. */
class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /** Monotonic time [ns]. RT-safe, from any thread. */
  [[nodiscard]] virtual std::int64_t NowNs() const noexcept = 0;
};

/** The machine's own, which goes on while the machine is suspended. */
[[nodiscard]] const Clock& SystemClock() noexcept;

/** Time that stands still until somebody moves it on. */
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override {
    return now_ns_.load(std::memory_order_acquire);
  }

  void Advance(std::int64_t step_ns) noexcept {
    now_ns_.fetch_add(step_ns, std::memory_order_acq_rel);
  }

 private:
  std::atomic<std::int64_t> now_ns_{0};
};

/** Processor time that the calling thread has used [ns]. RT-safe. */
[[nodiscard]] inline std::int64_t ThreadCpuNs() noexcept {
  return ReadClock(CLOCK_THREAD_CPUTIME_ID);
}

/** Time since 1970-01-01 UTC [ns]. For labels only: it can be set back. */
[[nodiscard]] inline std::int64_t WallClockNs() noexcept {
  return ReadClock(CLOCK_REALTIME);
}

}  // namespace hvas
