#include "base/job_thread.h"

#include <atomic>
#include <future>
#include <vector>

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(JobThreadTest, DoesAllInOrder) {
  std::vector<int> done;
  std::promise<void> last;
  JobThread thread;
  for (int i = 0; i < 100; ++i) {
    thread.Post([&done, i](const std::stop_token&) { done.push_back(i); });
  }
  thread.Post([&last](const std::stop_token&) { last.set_value(); });
  last.get_future().wait();
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
  }
}

TEST(JobThreadTest, StopWaitsForWhatHasBegunAndForgetsTheRest) {
  std::promise<void> begun;
  std::atomic<int> done{0};
  JobThread thread;
  thread.Post([&](const std::stop_token& stop) {
    begun.set_value();
    while (!stop.stop_requested()) {
      std::this_thread::yield();
    }
    ++done;
  });
  thread.Post([&done](const std::stop_token&) { ++done; });
  begun.get_future().wait();
  thread.Stop();
  EXPECT_EQ(done, 1);
  EXPECT_FALSE(thread.TryPost([](const std::stop_token&) {}, 10));
}

TEST(JobThreadTest, RefusesMoreThanMayWait) {
  std::promise<void> begun;
  JobThread thread;
  thread.Post([&begun](const std::stop_token& stop) {
    begun.set_value();
    while (!stop.stop_requested()) {
      std::this_thread::yield();
    }
  });
  begun.get_future().wait();
  const auto nothing = [](const std::stop_token&) {};
  EXPECT_TRUE(thread.TryPost(nothing, 2));
  EXPECT_TRUE(thread.TryPost(nothing, 2));
  EXPECT_FALSE(thread.TryPost(nothing, 2));
}

}  // namespace
}  // namespace hvas
