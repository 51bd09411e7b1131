#pragma once

#include <cstdint>
#include <ctime>

namespace hvas {

inline constexpr std::int64_t kNsPerSecond = 1'000'000'000;

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

/** Processor time that the calling thread has used [ns]. RT-safe. */
[[nodiscard]] inline std::int64_t ThreadCpuNs() noexcept {
  return ReadClock(CLOCK_THREAD_CPUTIME_ID);
}

/** Time since 1970-01-01 UTC [ns]. For labels only: it can be set back. */
[[nodiscard]] inline std::int64_t WallClockNs() noexcept {
  return ReadClock(CLOCK_REALTIME);
}

}  // namespace hvas
