#include "base/triple_buffer.h"

#include <thread>

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(TripleBuffer, HoldsTheInitialValueUntilTheFirstWrite) {
  TripleBuffer<int> buffer(7);
  EXPECT_FALSE(buffer.Update());
  EXPECT_EQ(buffer.value(), 7);
}

TEST(TripleBuffer, GivesTheNewestAndEachOnlyOnce) {
  TripleBuffer<int> buffer;
  for (int i = 1; i <= 5; ++i) {
    buffer.Write(i);
  }
  EXPECT_TRUE(buffer.Update());
  EXPECT_EQ(buffer.value(), 5);
  EXPECT_FALSE(buffer.Update());
  EXPECT_EQ(buffer.value(), 5);
  buffer.Write(6);
  EXPECT_EQ(buffer.value(), 5) << "changes only when the reader asks";
  EXPECT_TRUE(buffer.Update());
  EXPECT_EQ(buffer.value(), 6);
}

TEST(TripleBuffer, IsFilledInPlace) {
  TripleBuffer<std::array<int, 3>> buffer;
  buffer.back() = {1, 2, 3};
  EXPECT_FALSE(buffer.Update());
  buffer.Publish();
  EXPECT_TRUE(buffer.Update());
  EXPECT_EQ(buffer.value()[2], 3);
}

struct LargeMessage {
  std::uint64_t number{0};
  std::array<std::uint64_t, 31> copies{};
};

// No value is torn, none is older than the one before, and the last one always arrives.
TEST(TripleBufferThreads, NeverTearsNorGoesBack) {
  constexpr std::uint64_t kMessages = 500'000;  // Work, not time: a busy machine is only slow.
  TripleBuffer<LargeMessage> buffer;
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    for (std::uint64_t number = 1; number <= kMessages; ++number) {
      LargeMessage& message = buffer.back();
      message.number = number;
      message.copies.fill(number);
      buffer.Publish();
    }
    is_over = true;
  });
  std::uint64_t last = 0;
  bool is_intact = true;
  while (!is_over.load(std::memory_order_relaxed)) {
    if (!buffer.Update()) {
      std::this_thread::yield();
      continue;
    }
    const LargeMessage& message = buffer.value();
    is_intact = is_intact && message.number > last;
    for (const std::uint64_t copy : message.copies) {
      is_intact = is_intact && copy == message.number;
    }
    last = message.number;
  }
  writer.join();
  EXPECT_TRUE(is_intact);
  buffer.Update();
  EXPECT_EQ(buffer.value().number, kMessages);
}

}  // namespace
}  // namespace hvas
