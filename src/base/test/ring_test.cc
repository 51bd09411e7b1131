#include "base/ring.h"

#include <array>
#include <thread>

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(Ring, GivesBackInOrder) {
  Ring<int> ring(4);
  int value = 0;
  EXPECT_FALSE(ring.TryPop(&value));
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.TryPush(10 * round + i));
    }
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.TryPop(&value));
      EXPECT_EQ(value, 10 * round + i);
    }
    EXPECT_FALSE(ring.TryPop(&value));
  }
  EXPECT_EQ(ring.dropped(), 0u);
}

TEST(Ring, RefusesAndCountsWhenFullAndKeepsTheOld) {
  Ring<int> ring(5);
  EXPECT_EQ(ring.capacity(), 8u);
  for (int i = 0; i < 11; ++i) {
    EXPECT_EQ(ring.TryPush(i), i < 8);
  }
  EXPECT_EQ(ring.dropped(), 3u);
  int value = -1;
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(ring.TryPop(&value));
    EXPECT_EQ(value, i);
  }
  EXPECT_TRUE(ring.TryPush(99));
}

TEST(Ring, KeepsRoomForWhatMustNotBeLost) {
  constexpr std::size_t kReserve = 3;
  Ring<int> ring(8);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(ring.TryPush(i, kReserve), i < 5);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(ring.TryPush(100 + i));
  }
  EXPECT_FALSE(ring.TryPush(103));
  int value = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.TryPop(&value));
    EXPECT_EQ(ring.TryPush(200, kReserve), i == 3);
  }
}

struct Message {
  std::uint64_t number{0};
  std::array<std::uint64_t, 15> copies{};
};

// Every message arrives whole and in order, or was counted as dropped.
TEST(RingThreads, LosesNothingThatItAccepted) {
  constexpr std::uint64_t kEnough = 20000;
  Ring<Message> ring(64);
  std::atomic<bool> is_enough{false};
  std::atomic<bool> is_done{false};
  std::uint64_t sent = 0;
  std::thread writer([&] {
    while (!is_enough.load(std::memory_order_relaxed)) {
      Message message{++sent, {}};
      message.copies.fill(sent);
      ring.TryPush(message);
    }
    is_done.store(true, std::memory_order_release);
  });
  std::uint64_t received = 0;
  std::uint64_t last = 0;
  bool is_intact = true;
  Message message;
  for (;;) {
    const bool was_done = is_done.load(std::memory_order_acquire);
    if (ring.TryPop(&message)) {
      is_enough.store(++received >= kEnough, std::memory_order_relaxed);
      is_intact = is_intact && message.number > last;
      for (const std::uint64_t copy : message.copies) {
        is_intact = is_intact && copy == message.number;
      }
      last = message.number;
    } else if (was_done) {
      break;
    } else {
      std::this_thread::yield();
    }
  }
  writer.join();
  EXPECT_TRUE(is_intact);
  EXPECT_GE(received, kEnough);
  EXPECT_EQ(received + ring.dropped(), sent);
}

TEST(RingThreads, DropsNothingWhenTheWriterWaits) {
  constexpr std::uint64_t kMessages = 100000;
  Ring<std::uint64_t> ring(16);
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kMessages; ++i) {
      while (!ring.TryPush(i)) {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t expected = 0;
  bool is_in_order = true;
  while (expected < kMessages) {
    std::uint64_t value = 0;
    if (ring.TryPop(&value)) {
      is_in_order = is_in_order && value == expected;
      ++expected;
    } else {
      std::this_thread::yield();
    }
  }
  writer.join();
  EXPECT_TRUE(is_in_order);
}

}  // namespace
}  // namespace hvas
