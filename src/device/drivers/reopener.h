#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "base/clock.h"

namespace hvas::device {

/** Something that can be gone and be opened again. */
class Reopenable {
 public:
  Reopenable() = default;
  Reopenable(const Reopenable&) = delete;
  Reopenable& operator=(const Reopenable&) = delete;

  /** Opens it again; whether that worked. May wait. Not at the same time as the haptic thread. */
  virtual bool Reopen() = 0;

 protected:
  ~Reopenable() = default;
};

/** Opens a device again that is gone, every quarter of a second: on a thread of its own, or, in
 virtual time, which only the haptic thread knows, on that one. */
class Reopener {
 public:
  /** Time from one try to the next: a choice. */
  static constexpr std::int64_t kPeriodNs = 250'000'000;

  Reopener(Reopenable* device, const Clock& clock);
  Reopener(const Reopener&) = delete;
  Reopener& operator=(const Reopener&) = delete;
  ~Reopener();

  /** Whether the device is there, so that the haptic thread may touch it. RT-safe in real time. */
  [[nodiscard]] bool IsThere() noexcept;

  /** The haptic thread found out that it is gone, and leaves it alone from now on. RT-safe. */
  void Lose() noexcept { is_gone_.store(true, std::memory_order_release); }

 private:
  void Run();

  Reopenable& device_;
  const Clock& clock_;
  const bool is_virtual_;
  std::int64_t retry_ns_{0};
  std::atomic<bool> is_gone_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stops_{false};
  std::thread thread_;
};

}  // namespace hvas::device
