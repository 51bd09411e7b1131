#include "base/digest.h"

#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace hvas {
namespace {

std::string HexOf(std::string_view bytes) {
  Digest digest;
  digest.AddBytes(std::as_bytes(std::span(bytes)));
  return digest.Hex();
}

// XXH3 with 128 bits of nothing: the value printed by xxhsum -H2 for an empty file.
TEST(Digest, OfNothingIsThePublishedValue) {
  EXPECT_EQ(Digest().Hex(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(Checksum64({}), 0x2d06800538d394c2ull);
}

TEST(Digest, DoesNotDependOnHowTheBytesAreCut) {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) {
    bytes += static_cast<char>(i * 7);
  }
  for (const std::size_t cut : {1u, 3u, 64u, 999u}) {
    Digest digest;
    for (std::size_t at = 0; at < bytes.size(); at += cut) {
      digest.AddBytes(std::as_bytes(std::span(std::string_view(bytes).substr(at, cut))));
    }
    EXPECT_EQ(digest.Hex(), HexOf(bytes));
  }
}

TEST(Digest, ChangesWithEveryBit) {
  std::array<char, 40> bytes{};
  std::set<std::string> seen{HexOf({bytes.data(), bytes.size()})};
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    seen.insert(HexOf({bytes.data(), bytes.size()}));
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
  }
  EXPECT_EQ(seen.size(), 8 * bytes.size() + 1);
}

TEST(Digest, NumbersAreLittleEndianAndTextsKeepTheirBorders) {
  Digest number;
  number.AddInt(0x0807060504030201);
  EXPECT_EQ(number.Hex(), HexOf("\x01\x02\x03\x04\x05\x06\x07\x08"));
  Digest one;
  one.AddDouble(1.0);
  EXPECT_EQ(one.Hex(), HexOf({"\0\0\0\0\0\0\xf0\x3f", 8}));
  Digest left;
  left.AddText("ab");
  left.AddText("c");
  Digest right;
  right.AddText("a");
  right.AddText("bc");
  EXPECT_NE(left.Hex(), right.Hex());
}

TEST(Digest, GoesOnAfterItWasRead) {
  Digest digest;
  digest.AddText("a");
  const std::string first = digest.Hex();
  EXPECT_EQ(digest.Hex(), first);
  digest.AddText("b");
  EXPECT_NE(digest.Hex(), first);
}

}  // namespace
}  // namespace hvas
