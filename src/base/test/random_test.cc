#include "base/random.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace hvas {
namespace {

// An independent writing of the published algorithm (xoshiro256**, SplitMix64 seeding), step by
// step from the paper's description rather than from the code under test.
class Reference {
 public:
  explicit Reference(std::uint64_t seed) {
    for (int i = 0; i < 4; ++i) {
      const std::uint64_t x = seed + static_cast<std::uint64_t>(i + 1) * 0x9e3779b97f4a7c15ull;
      const std::uint64_t y = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
      const std::uint64_t z = (y ^ y >> 27) * 0x94d049bb133111ebull;
      s_[i] = z ^ z >> 31;
    }
  }

  std::uint64_t Next() {
    const std::uint64_t five = s_[1] * 5;
    const std::uint64_t result = (five << 7 | five >> 57) * 9;
    const std::uint64_t n0 = s_[0] ^ s_[1] ^ s_[3];
    const std::uint64_t n1 = s_[0] ^ s_[1] ^ s_[2];
    const std::uint64_t n2 = s_[0] ^ s_[2] ^ s_[1] << 17;
    const std::uint64_t d = s_[1] ^ s_[3];
    s_[0] = n0;
    s_[1] = n1;
    s_[2] = n2;
    s_[3] = d << 45 | d >> 19;
    return result;
  }

 private:
  std::uint64_t s_[4];
};

TEST(Random, FollowsThePublishedAlgorithm) {
  for (const std::uint64_t seed : {0ull, 1ull, 20250101ull}) {
    Random random(seed);
    Reference reference(seed);
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(random.NextBits(), reference.Next()) << "seed " << seed << ", draw " << i;
    }
  }
}

TEST(Random, StreamsOfDifferentSeedsDiffer) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed);
    for (int i = 0; i < 10; ++i) {
      seen.insert(random.NextBits());
    }
  }
  EXPECT_EQ(seen.size(), 1000u);
}

TEST(Random, UniformHasTheMomentsOfItsRange) {
  Random random(5);
  constexpr int kDraws = 200000;
  double sum = 0;
  double square = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Uniform(-1, 3);
    ASSERT_GE(x, -1);
    ASSERT_LT(x, 3);
    sum += x;
    square += x * x;
  }
  const double mean = sum / kDraws;
  EXPECT_NEAR(mean, 1.0, 0.013);  // 5 standard errors: 4 / sqrt(12 n) = 0.0026 each.
  EXPECT_NEAR(square / kDraws - mean * mean, 16.0 / 12.0, 0.014);
}

TEST(Random, NormalHasTheMomentsOfTheBell) {
  Random random(6);
  constexpr int kDraws = 200000;
  double sum = 0;
  double square = 0;
  int within_one = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    square += x * x;
    within_one += std::abs(x) < 1 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.0112);
  EXPECT_NEAR(square / kDraws, 1.0, 0.0159);
  EXPECT_NEAR(static_cast<double>(within_one) / kDraws, std::erf(std::sqrt(0.5)), 0.0053);
}

}  // namespace
}  // namespace hvas
