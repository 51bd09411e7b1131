#include "record/compression.h"

#include <gtest/gtest.h>

#include "record/test/sample.h"

namespace hvas::record {
namespace {

TEST(Compression, BringsBytesBack) {
  for (const std::size_t size : {0, 1, 1000, 100'000}) {
    const std::vector<std::byte> bytes = MakeBytes(1, size);
    EXPECT_EQ(Decompress(Compress(bytes), size), bytes) << size;
  }
  const std::vector<std::byte> equal(100'000, std::byte{7});
  EXPECT_LT(Compress(equal).size(), 1000u);
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
