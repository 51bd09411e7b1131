#include "record/compression.h"

#include <cmath>

#include <gtest/gtest.h>

#include "record/packing.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

constexpr std::size_t kPackedTicks = 250;

std::vector<std::byte> PackTicks(TickRecord (*make)(std::int64_t)) {
  std::vector<std::byte> packed;
  for (std::size_t i = 0; i < kPackedTicks; ++i) {
    std::array<std::byte, kPackedTickSize> bytes{};
    Pack(make(static_cast<std::int64_t>(i)), bytes);
    packed.insert(packed.end(), bytes.begin(), bytes.end());
  }
  return packed;
}

/** Smooth motion with a noise of the encoders. */
TickRecord MakeMoving(std::int64_t number) {
  const TickRecord noise = MakeTick(number);
  TickRecord tick;
  tick.t_ns = number * kTickNs;
  const double t = 1e-3 * static_cast<double>(number);
  const Vec3 p = Vec3(std::sin(t), std::cos(t), t) + 1e-5 * noise.X_WH.p();
  tick.device_pose = spatial::Pose(p);
  tick.X_WH = spatial::Pose(2 * p);
  tick.X_WD = spatial::Pose(2 * p);
  return tick;
}

TEST(Compression, BringsBytesBack) {
  for (const std::size_t size : {0, 1, 1000, 100'000}) {
    const std::vector<std::byte> bytes = MakeBytes(1, size);
    EXPECT_EQ(Decompress(Compress(bytes), size), bytes) << size;
  }
  const std::vector<std::byte> equal(100'000, std::byte{7});
  EXPECT_LT(Compress(equal).size(), 1000u);
}

TEST(Compression, BringsTicksBackBitForBit) {
  for (const auto make : {&MakeTick, &MakeMoving}) {
    const std::vector<std::byte> packed = PackTicks(make);
    const std::vector<std::byte> block = CompressTicks(packed, kPackedTickSize);
    EXPECT_EQ(DecompressTicks(block, kPackedTickSize, kPackedTicks), packed);
    EXPECT_TRUE(DecompressTicks(block, kPackedTickSize, kPackedTicks - 1).empty());
    EXPECT_TRUE(DecompressTicks(block, kPackedTickSize, kPackedTicks + 1).empty());
  }
}

TEST(Compression, OfTicksThatMoveSmoothlyIsBetterThanOfTheirBytes) {
  const std::vector<std::byte> packed = PackTicks(&MakeMoving);
  EXPECT_LT(CompressTicks(packed, kPackedTickSize).size(), Compress(packed).size());
}

TEST(Compression, TakesAnyBytes) {
  const std::vector<std::byte> block = Compress(MakeBytes(1, 1000));
  EXPECT_TRUE(Decompress(block, 999).empty()) << "more than the limit";
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    EXPECT_TRUE(Decompress(MakeBytes(i, 100), 1000).empty());
    std::vector<std::byte> damaged = block;
    damaged[static_cast<std::size_t>(i) % damaged.size()] ^= std::byte{1};
    refused += Decompress(damaged, 1000) != MakeBytes(1, 1000) ? 1 : 0;
    const auto cut = std::span(block).first(static_cast<std::size_t>(i));
    EXPECT_TRUE(Decompress(cut, 1000).empty());
  }
  EXPECT_GT(refused, 250);
}

}  // namespace
}  // namespace hvas::record
