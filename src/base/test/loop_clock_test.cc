#include "base/loop_clock.h"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

namespace hvas {
namespace {

const std::function<bool()> kNever = [] { return false; };

/** A thread that counts its deadlines, each a period after the one before. */
class Counter {
 public:
  Counter(SteeredClock* clock, std::int64_t period_ns) : clock_(clock) {
    clock->Enter();
    thread_ = std::thread([this, period_ns] {
      std::int64_t next_ns = clock_->NowNs();
      while (!is_over_) {
        next_ns += period_ns;
        clock_->WaitUntil(next_ns, [this] { return is_over_.load(); });
        was_late_ = was_late_ || (!is_over_ && clock_->NowNs() != next_ns);
        count_ += is_over_ ? 0 : 1;
      }
      clock_->Leave();
    });
  }

  ~Counter() {
    is_over_ = true;
    clock_->WakeAll();
    thread_.join();
  }

  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  [[nodiscard]] int count() const { return count_; }

  [[nodiscard]] bool was_late() const { return was_late_; }

 private:
  SteeredClock* clock_;
  std::atomic<bool> is_over_{false};
  std::atomic<int> count_{0};
  std::atomic<bool> was_late_{false};
  std::thread thread_;
};

TEST(SteeredClockTest, TimeStandsStillUntilItsOwnerLetsItGoOn) {
  SteeredClock clock;
  const Counter counter(&clock, 10);
  const std::int64_t start_ns = clock.NowNs();
  std::this_thread::yield();
  EXPECT_EQ(counter.count(), 0);
  clock.Advance(9);
  EXPECT_EQ(clock.NowNs(), start_ns + 9);
  EXPECT_EQ(counter.count(), 0);
  clock.Advance(1);
  EXPECT_EQ(counter.count(), 1) << "what is due at the end has been done";
}

TEST(SteeredClockTest, NoThreadMissesADeadlineAndAllHaveDoneTheirsWhenTimeHasPassed) {
  SteeredClock clock;
  const Counter fast(&clock, 1);
  const Counter slow(&clock, 10);
  const Counter odd(&clock, 7);
  for (int step = 1; step <= 20; ++step) {
    clock.Advance(70);
    ASSERT_EQ(fast.count(), 70 * step);
    ASSERT_EQ(slow.count(), 7 * step);
    ASSERT_EQ(odd.count(), 10 * step);
  }
  EXPECT_FALSE(fast.was_late() || slow.was_late() || odd.was_late());
}

TEST(SteeredClockTest, TimePassesWithoutThreadsAndAfterTheyHaveLeft) {
  SteeredClock clock;
  const std::int64_t start_ns = clock.NowNs();
  clock.Advance(5);
  {
    const Counter counter(&clock, 10);
    clock.Advance(20);
  }
  clock.Advance(5);
  EXPECT_EQ(clock.NowNs(), start_ns + 30);
  EXPECT_FALSE(clock.has_threads());
}

TEST(SteeredClockTest, WhatIsOverAlreadyDoesNotWait) {
  SteeredClock clock;
  clock.WaitUntil(clock.NowNs() + 10, [] { return true; });
  clock.WaitUntil(clock.NowNs(), kNever);
}

TEST(ClockDriverTest, LetsTimeGoOnAsItsPaceAllows) {
  SteeredClock clock;
  std::atomic<int> steps{0};
  const std::int64_t start_ns = clock.NowNs();
  {
    const Counter counter(&clock, ClockDriver::kStepNs);
    std::atomic<bool> is_enough{false};
    const ClockDriver driver(&clock, [&](const std::stop_token&) {
      is_enough = ++steps > 20;
      is_enough.notify_one();
    });
    is_enough.wait(false);
  }
  EXPECT_LE(clock.NowNs(), start_ns + steps * ClockDriver::kStepNs);
  EXPECT_GE(clock.NowNs(), start_ns + 20 * ClockDriver::kStepNs);
}

}  // namespace
}  // namespace hvas
