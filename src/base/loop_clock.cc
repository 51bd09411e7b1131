#include "base/loop_clock.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <utility>

namespace hvas {
namespace {

/** SystemClock() to wait by: the time for which the machine was suspended counts. */
class MachineLoopClock final : public LoopClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override { return ReadClock(CLOCK_BOOTTIME); }

  void WaitUntil(std::int64_t t_ns, const std::function<bool()>& /*is_over*/) noexcept override {
    const timespec deadline{t_ns / kNsPerSecond, t_ns % kNsPerSecond};
    while (::clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
    }
  }

  void Enter() noexcept override {}

  void Leave() noexcept override {}

  void WakeAll() noexcept override {}

  [[nodiscard]] bool is_steered() const noexcept override { return false; }
};

}  // namespace

LoopClock& MachineClock() noexcept {
  static MachineLoopClock clock;
  return clock;
}

void SteeredClock::Advance(std::int64_t step_ns) noexcept {
  std::unique_lock lock(mutex_);
  end_ns_ = now_ns_ + step_ns;
  MoveOn();
  arrived_.wait(lock, [this] { return now_ns_ == end_ns_ && do_all_wait(); });
}

void SteeredClock::WaitUntil(std::int64_t t_ns, const std::function<bool()>& is_over) noexcept {
  std::unique_lock lock(mutex_);
  Waiter self;
  self.t_ns = t_ns;
  self.is_over = &is_over;
  if (t_ns <= now_ns_ || is_over()) {
    return;
  }
  waiters_.push_back(&self);
  MoveOn();
  self.released.wait(lock, [&self] { return self.is_released; });
}

void SteeredClock::Enter() noexcept {
  const std::lock_guard lock(mutex_);
  ++entered_;
}

void SteeredClock::Leave() noexcept {
  const std::lock_guard lock(mutex_);
  --entered_;
  MoveOn();
}

void SteeredClock::WakeAll() noexcept {
  const std::lock_guard lock(mutex_);
  Release([](const Waiter& waiter) { return (*waiter.is_over)(); });
}

void SteeredClock::Release(const std::function<bool(const Waiter&)>& holds) {
  const auto kept = std::stable_partition(waiters_.begin(), waiters_.end(),
                                          [&](const Waiter* waiter) { return !holds(*waiter); });
  std::for_each(kept, waiters_.end(), [](Waiter* waiter) {
    waiter->is_released = true;
    waiter->released.notify_one();
  });
  waiters_.erase(kept, waiters_.end());
}

void SteeredClock::MoveOn() {
  while (do_all_wait() && now_ns_ < end_ns_) {
    std::int64_t next_ns = end_ns_;
    for (const Waiter* waiter : waiters_) {
      next_ns = std::min(next_ns, waiter->t_ns);
    }
    now_ns_ = next_ns;
    Release([next_ns](const Waiter& waiter) { return waiter.t_ns <= next_ns; });
  }
  if (do_all_wait()) {
    arrived_.notify_all();
  }
}

bool SteeredClock::has_threads() const noexcept {
  const std::lock_guard lock(mutex_);
  return entered_ > 0;
}

ClockDriver::ClockDriver(SteeredClock* clock, std::function<void(const std::stop_token&)> pace)
    : thread_([clock, pace = std::move(pace)](const std::stop_token& stop) {
        constexpr std::chrono::milliseconds kNap(1);  // while there is nobody to go on for
        while (!stop.stop_requested()) {
          if (pace) {
            pace(stop);
          }
          if (!clock->has_threads()) {
            std::this_thread::sleep_for(kNap);
          }
          clock->Advance(kStepNs);
        }
      }) {}

ClockDriver::~ClockDriver() = default;

}  // namespace hvas
