#include "base/clock.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(Clock, MonotonicNeverGoesBackAndCountsSleep) {
  const std::int64_t before_ns = MonotonicNs();
  std::int64_t last_ns = before_ns;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t now_ns = MonotonicNs();
    ASSERT_GE(now_ns, last_ns);
    last_ns = now_ns;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_GE(MonotonicNs() - last_ns, 20'000'000);
}

TEST(Clock, ThreadTimeStandsStillInSleepAndRunsInWork) {
  const std::int64_t before_ns = ThreadCpuNs();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::int64_t slept_ns = ThreadCpuNs();
  EXPECT_LT(slept_ns - before_ns, 25'000'000);
  volatile int sink = 0;
  while (ThreadCpuNs() - slept_ns < 5'000'000) {
    sink = sink + 1;
  }
  EXPECT_GT(sink, 0);
}

TEST(Clock, WallClockAgreesWithTheStandardLibrary) {
  const auto expected = std::chrono::duration_cast<std::chrono::nanoseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count();
  EXPECT_NEAR(static_cast<double>(WallClockNs() - expected), 0, 1e9);
}

}  // namespace
}  // namespace hvas
