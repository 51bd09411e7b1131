#include "app/end_watch.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

namespace hvas::app {
namespace {

/** Exit status of a process that watches for its end, does something, and is told to end. */
int StatusOf(int signal, const std::function<void(EndWatch*)>& work) {
  std::array<int, 2> ready{};
  EXPECT_EQ(::pipe(ready.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    {
      EndWatch end(std::chrono::milliseconds(200));
      EXPECT_EQ(::write(ready[1], "x", 1), 1);
      work(&end);
    }
    ::_exit(0);
  }
  char seen = 0;
  EXPECT_EQ(::read(ready[0], &seen, 1), 1);
  ::kill(child, signal);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  ::close(ready[0]);
  ::close(ready[1]);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class EndWatchTest : public ::testing::TestWithParam<int> {};

TEST_P(EndWatchTest, ProgramThatEndsInOrderHasStatusZero) {
  EXPECT_EQ(StatusOf(GetParam(), [](EndWatch* end) { end->Wait(); }), 0);
}

TEST_P(EndWatchTest, ProgramThatHangsEnds) {
  const auto hangs = [](EndWatch* end) {
    end->Wait();
    for (;;) {
      ::pause();
    }
  };
  EXPECT_EQ(StatusOf(GetParam(), hangs), 1);
}

TEST_P(EndWatchTest, ProgramThatNeverComesToWaitEnds) {
  EXPECT_EQ(StatusOf(GetParam(),
                     [](EndWatch*) {
                       for (std::atomic<bool> is_busy{true}; is_busy.load();) {
                       }
                     }),
            1);
}

TEST_P(EndWatchTest, ProgramThatWaitsForItselfEnds) {
  const auto waits = [](EndWatch* end) {
    end->Wait();
    std::mutex mutex;
    const std::lock_guard held(mutex);
    std::thread other([&mutex] { const std::lock_guard never(mutex); });
    other.join();
  };
  EXPECT_EQ(StatusOf(GetParam(), waits), 1);
}

INSTANTIATE_TEST_SUITE_P(Signals, EndWatchTest, ::testing::Values(SIGTERM, SIGINT));

TEST(EndWatchAloneTest, NeedsNoSignalToGo) {
  const EndWatch end;
}

}  // namespace
}  // namespace hvas::app
