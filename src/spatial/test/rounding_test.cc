#include "spatial/rounding.h"

#include <bit>
#include <limits>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::spatial {
namespace {

constexpr double kStep = 0x1p-20;

TEST(RoundTo, GivesTheNearestMultiple) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double value = random.Uniform(-3, 3);
    const double rounded = RoundTo(kStep, value);
    EXPECT_LE(std::abs(rounded - value), kStep / 2);
    EXPECT_EQ(std::fmod(rounded, kStep), 0);
    EXPECT_EQ(RoundTo(kStep, rounded), rounded);
  }
  EXPECT_EQ(RoundTo(kStep, -5 * kStep), -5 * kStep);
}

TEST(RoundTo, HasNoNegativeZero) {
  for (const double value : {-0.0, -kStep / 3}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(RoundTo(kStep, value)), 0U);
  }
}

TEST(RoundTo, LeavesWhatHasNoFractionOfAStep) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value : {kInfinity, -kInfinity, 1e300, -1e300, 0x1p40}) {
    EXPECT_EQ(RoundTo(kStep, value), value);
  }
  EXPECT_TRUE(std::isnan(RoundTo(kStep, std::numeric_limits<double>::quiet_NaN())));
}

TEST(Rounded, TurnsAndMovesAPoseByLessThanIsMeasured) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Quat q(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1),
                 random.Uniform(-1, 1));
    const Pose X(q.normalized(), Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), 0.3));
    const Pose rounded = Rounded(X);
    EXPECT_LT((rounded.p() - X.p()).norm(), 1e-9);
    EXPECT_LT(RotationBetween(rounded.q().normalized(), X.q()).norm(), 3e-9);
    EXPECT_NEAR(rounded.q().norm(), 1, 2e-9);
  }
}

}  // namespace
}  // namespace hvas::spatial
