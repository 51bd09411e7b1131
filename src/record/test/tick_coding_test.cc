#include "record/tick_coding.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "record/compression.h"
#include "record/packing.h"
#include "record/range_coder.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

constexpr std::size_t kTicksOfBlock = 250;

std::vector<std::byte> PackTicks(const std::function<TickRecord(std::int64_t)>& make,
                                 std::size_t count = kTicksOfBlock) {
  std::vector<std::byte> packed;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<std::byte, kPackedTickSize> bytes{};
    Pack(make(static_cast<std::int64_t>(i)), bytes);
    packed.insert(packed.end(), bytes.begin(), bytes.end());
  }
  return packed;
}

/** A hand that trembles as it goes round, and a part that it holds, in free space. */
TickRecord MakeMoving(std::int64_t number) {
  constexpr double kDt = 1e-3;  // [s]
  spatial::Pose X_WH(Vec3(0.3, 0.1, 0.2));
  spatial::Twist V;
  for (std::int64_t i = 0; i <= number; ++i) {
    const double t = kDt * static_cast<double>(i);
    const double tremor = 1e-3 * std::sin(2 * std::numbers::pi * 9.7 * t);
    V.v = Vec3(0.1 * std::sin(t) + tremor, 0.1 * std::cos(t), 0.02 * t);
    V.w = Vec3(0.2, 0.1 * std::sin(t), tremor);
    X_WH = spatial::Integrate(X_WH, V, kDt);
  }
  TickRecord tick;
  tick.t_ns = number * kTickNs;
  tick.device_pose = X_WH;
  tick.device_twist = V;
  tick.X_WH = X_WH * spatial::Pose(Quat(0.8, 0, 0.6, 0), Vec3(0.01, 0.02, 0.03));
  tick.X_WD = tick.X_WH;
  tick.F_felt_W.f = Vec3(0, 0.1, -2) + 0.5 * V.v;
  tick.F_true_W.f = tick.F_felt_W.f - Vec3(0, 0, 8);
  return tick;
}

/** Numbers that are no quantities. */
TickRecord MakeOdd(std::int64_t number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array kNumbers{0.0,
                                -0.0,
                                kInfinity,
                                -kInfinity,
                                std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::denorm_min(),
                                -std::numeric_limits<double>::max(),
                                1.0};
  const auto at = [&](std::int64_t k) {
    return kNumbers[static_cast<std::size_t>((number + k) % std::ssize(kNumbers))];
  };
  TickRecord tick = MakeTick(number);
  tick.device_pose = spatial::Pose(Quat(at(0), at(1), at(2), at(3)), Vec3(at(4), at(5), at(6)));
  tick.device_twist.v = Vec3(at(1), at(2), at(3));
  tick.F_true_W.f = Vec3(at(2), at(4), at(6));
  tick.depth = at(3);
  tick.device_grip = at(5);
  tick.contacts[0].distance = static_cast<float>(at(6) > 0 ? at(6) : 0.0);
  tick.t_ns = number % 3 == 0 ? std::numeric_limits<std::int64_t>::min() : number;
  return tick;
}

/** Two hands take turns. */
TickRecord MakeSecond(std::int64_t number) {
  TickRecord tick = number % 2 == 0 ? MakeMoving(number / 2)
                                    : MakeMoving(std::int64_t{kTicksOfBlock} - number / 2);
  tick.hand = static_cast<std::uint8_t>(number % 2);
  return tick;
}

TEST(TickCoding, BringsTicksBackBitForBit) {
  for (const auto make : {&MakeTick, &MakeMoving, &MakeOdd, &MakeSecond}) {
    for (const std::size_t count : {std::size_t{1}, kTicksOfBlock}) {
      const std::vector<std::byte> packed = PackTicks(make, count);
      const std::vector<std::byte> block = EncodeTicks(packed);
      EXPECT_EQ(DecodeTicks(block, count, kSchemaVersion), packed);
      EXPECT_TRUE(DecodeTicks(block, count - 1, kSchemaVersion).empty());
      EXPECT_TRUE(DecodeTicks(block, count + 1, kSchemaVersion).empty());
    }
  }
}

TEST(TickCoding, TakesATenthOfTheBytesWhereTheHandMovesSmoothly) {
  for (const auto make : {&MakeMoving, &MakeSecond}) {
    const std::vector<std::byte> packed = PackTicks(make);
    EXPECT_LT(EncodeTicks(packed).size(), packed.size() / 10);
    EXPECT_LT(3 * EncodeTicks(packed).size(), Compress(packed).size());
  }
}

// A tick in the steps of a record takes less than half of one that is not, and comes back as well.
TEST(TickCoding, TakesLittleWhereTicksAreRounded) {
  const auto make_rounded = [](std::int64_t number) { return Rounded(MakeMoving(number)); };
  const std::vector<std::byte> packed = PackTicks(make_rounded);
  const std::vector<std::byte> block = EncodeTicks(packed);
  EXPECT_EQ(DecodeTicks(block, kTicksOfBlock, kSchemaVersion), packed);
  EXPECT_LT(2 * block.size(), EncodeTicks(PackTicks(&MakeMoving)).size());
}

// Numbers that are not finite are none of a step, and neither are those of a hand that is not
// rounded: each tick is coded as it is.
TEST(TickCoding, BringsRoundedAndOtherTicksBackInTurns) {
  const auto make = [](std::int64_t number) {
    const TickRecord tick = number % 7 == 0 ? MakeOdd(number) : MakeSecond(number);
    return number % 3 == 0 ? tick : Rounded(tick);
  };
  const std::vector<std::byte> packed = PackTicks(make);
  EXPECT_EQ(DecodeTicks(EncodeTicks(packed), kTicksOfBlock, kSchemaVersion), packed);
}

// What has no pattern takes hardly more than its bytes.
TEST(TickCoding, AddsLittleToNoise) {
  const std::vector<std::byte> packed = PackTicks(&MakeTick);
  EXPECT_LT(EncodeTicks(packed).size(), packed.size() + packed.size() / 20);
}

TEST(TickCoding, TakesAnyBytes) {
  const std::vector<std::byte> packed = PackTicks(&MakeMoving, 20);
  const std::vector<std::byte> block = EncodeTicks(packed);
  for (int i = 0; i < 300; ++i) {
    const std::vector<std::byte> noise = MakeBytes(i, static_cast<std::size_t>(i));
    const std::size_t size = DecodeTicks(noise, 20, kSchemaVersion).size();
    EXPECT_TRUE(size == 0 || size == packed.size());
    std::vector<std::byte> damaged = block;
    damaged[static_cast<std::size_t>(i) % damaged.size()] ^= std::byte{1};
    EXPECT_NE(DecodeTicks(damaged, 20, kSchemaVersion), packed);
    const auto cut = std::span(block).first(static_cast<std::size_t>(i) % block.size());
    EXPECT_TRUE(DecodeTicks(cut, 20, kSchemaVersion).empty());
  }
}

// A bit of probability p is worth -log2 p: a thousand bits of which one in ten is set, 469.
TEST(RangeCoding, ComesNearTheEntropyOfItsBits) {
  constexpr int kBits = 1000;
  RangeEncoder encoder;
  BitModel model;
  for (int i = 0; i < kBits; ++i) {
    bool bit = i % 10 == 0;
    encoder.Code(&model, &bit);
  }
  const std::vector<std::byte> bytes = encoder.Finish();
  EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 1.25 * 469);
  RangeDecoder decoder(bytes);
  BitModel same;
  for (int i = 0; i < kBits; ++i) {
    bool bit = false;
    decoder.Code(&same, &bit);
    EXPECT_EQ(bit, i % 10 == 0);
  }
  EXPECT_TRUE(decoder.is_at_end());
}

// All bits set makes carries go through many bytes.
TEST(RangeCoding, CarriesThroughAnyNumberOfBytes) {
  for (const std::uint64_t pattern :
       {~std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{1} << 63}) {
    RangeEncoder encoder;
    for (int i = 0; i < 100; ++i) {
      std::uint64_t bits = pattern >> (64 - i % 64 - 1);
      encoder.CodeBits(i % 64 + 1, &bits);
    }
    const std::vector<std::byte> bytes = encoder.Finish();
    RangeDecoder decoder(bytes);
    for (int i = 0; i < 100; ++i) {
      std::uint64_t bits = 0;
      decoder.CodeBits(i % 64 + 1, &bits);
      EXPECT_EQ(bits, pattern >> (64 - i % 64 - 1));
    }
    EXPECT_TRUE(decoder.is_at_end());
  }
}

}  // namespace
}  // namespace hvas::record
