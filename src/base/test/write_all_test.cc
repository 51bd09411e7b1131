#include "base/write_all.h"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(WriteAll, SignalsDoNotCutItShort) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);

  struct sigaction before {};

  struct sigaction interrupt {};  // Without SA_RESTART.

  interrupt.sa_handler = [](int /*signal*/) {};
  ASSERT_EQ(::sigaction(SIGUSR1, &interrupt, &before), 0);
  std::vector<std::byte> sent(1'000'000);  // Far more than a pipe holds: it has to wait.
  for (std::size_t i = 0; i < sent.size(); ++i) {
    sent[i] = static_cast<std::byte>(i % 251);
  }
  int error = -1;
  std::thread writer([&] {
    error = WriteAll(pipe[1], sent);
    ::close(pipe[1]);
  });
  std::vector<std::byte> received;
  std::array<std::byte, 50'000> block{};
  for (bool is_open = true; is_open;) {
    for (int i = 0; i < 3 && received.size() < sent.size() / 2; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      ::pthread_kill(writer.native_handle(), SIGUSR1);
    }
    const ssize_t size = ::read(pipe[0], block.data(), block.size());
    is_open = size > 0;
    received.insert(received.end(), block.data(), block.data() + std::max<ssize_t>(size, 0));
  }
  writer.join();
  ::sigaction(SIGUSR1, &before, nullptr);
  ::close(pipe[0]);
  EXPECT_EQ(error, 0);
  EXPECT_EQ(received, sent);
}

TEST(WriteAll, TellsWhatWentWrong) {
  const std::array<std::byte, 3> bytes{};
  EXPECT_EQ(WriteAll(-1, bytes), EBADF);
  EXPECT_EQ(WriteAll(-1, {}), 0) << "nothing to write";
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  EXPECT_EQ(WriteAll(full, bytes), ENOSPC);
  ::close(full);
}

}  // namespace
}  // namespace hvas
