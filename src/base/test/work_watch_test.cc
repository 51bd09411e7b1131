#include "base/work_watch.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/clock.h"

namespace hvas {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20U;

TEST(WorkWatchTest, WorkWithoutAWatchGoesOn) {
  EXPECT_TRUE(MayGoOn(nullptr));
}

TEST(WorkWatchTest, TimeThatIsUpEndsTheWorkForGood) {
  WorkWatch watch({0.02, 0});
  EXPECT_TRUE(watch.MayGoOn());
  while (watch.MayGoOn()) {
  }
  EXPECT_FALSE(watch.MayGoOn());
  const Error error = watch.Explain("finding the mates", "rig.step");
  EXPECT_EQ(error.code, ErrorCode::kOutOfResource);
  EXPECT_EQ(error.ToString(),
            "rig.step: finding the mates took longer than 0.02 s, which is the limit (raise "
            "--time-limit, or export the product in parts)");
}

TEST(WorkWatchTest, MemoryThatIsUsedUpEndsTheWork) {
  WorkWatch watch({1000, 64 * kMebibyte});
  std::vector<std::unique_ptr<std::vector<char>>> blocks;
  while (watch.MayGoOn() && blocks.size() < 4096) {
    blocks.push_back(std::make_unique<std::vector<char>>(kMebibyte, 'x'));
  }
  EXPECT_LT(blocks.size(), 4096U);
  EXPECT_GT(blocks.size(), 32U);
  const Error error = watch.Explain("finding the mates", "rig.step");
  EXPECT_EQ(error.code, ErrorCode::kOutOfResource);
  EXPECT_NE(error.message.find("0.0625 GiB"), std::string::npos) << error.message;
  EXPECT_NE(error.remedy.find("--memory-limit"), std::string::npos);
}

TEST(WorkWatchTest, WhatWasInUseBeforeDoesNotCount) {
  const std::vector<char> before(128 * kMebibyte, 'x');
  WorkWatch watch({1000, 64 * kMebibyte});
  EXPECT_TRUE(watch.MayGoOn());
  EXPECT_EQ(before.back(), 'x');
}

TEST(WorkWatchTest, StopThatIsAskedForEndsTheWork) {
  std::stop_source source;
  WorkWatch watch({1000, 0}, source.get_token());
  EXPECT_TRUE(watch.MayGoOn());
  source.request_stop();
  while (watch.MayGoOn()) {
  }
  EXPECT_EQ(watch.Explain("finding the mates", "rig.step").code, ErrorCode::kCancelled);
}

TEST(WorkWatchTest, TimeIsCountedFromWhereTheWorkBegan) {
  WorkLimits limits;
  limits.begin_ns = MonotonicNs() - std::int64_t{100} * 1'000'000'000;
  limits.time = 99;
  EXPECT_FALSE(WorkWatch(limits).MayGoOn());
  limits.time = 1000;
  EXPECT_TRUE(WorkWatch(limits).MayGoOn());
}

TEST(WorkWatchTest, PairsBeyondTheLimitEndTheWorkAndAreNamed) {
  WorkLimits limits;
  limits.pairs = 3;
  WorkWatch watch(limits);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(watch.MayVisitPair());
  }
  EXPECT_FALSE(watch.MayVisitPair());
  EXPECT_FALSE(watch.MayGoOn());
  EXPECT_EQ(watch.Explain("finding the mates", "rig.step").ToString(),
            "rig.step: finding the mates had more than 3 pairs of parts to look at, which is the "
            "limit (export the product in parts)");
}

TEST(WorkWatchTest, DefaultMemoryIsThatOfAUsualMachine) {
  EXPECT_GT(DefaultMemoryLimit(), 64 * kMebibyte);
  EXPECT_LE(DefaultMemoryLimit(), std::uint64_t{4} << 30U);
}

}  // namespace
}  // namespace hvas
