// What counts as buzzing, swing by swing: N6.

#include "haptics/buzz_detector.h"

#include <gtest/gtest.h>

namespace hvas::haptics {
namespace {

constexpr double kBuzzPeriod = 1e-3;  // [s]

/** Lets a hand swing to and fro along an axis, with a force against it.
 @param ticks  Of a swing one way.
 @returns how often the motion had turned round when buzzing was found; 0: never in 40 swings. */
int CountReversals(int ticks, double speed, double force, int axis = 0) {
  BuzzDetector detector({});
  for (int swing = 0; swing < 40; ++swing) {
    const double sign = swing % 2 == 0 ? 1 : -1;
    for (int i = 0; i < ticks; ++i) {
      Vec3 v = Vec3::Zero();
      Vec3 f = Vec3::Zero();
      v[axis] = sign * speed;
      f[axis] = -sign * force;
      if (detector.Update(v, f, kBuzzPeriod)) {
        return swing;
      }
    }
  }
  return 0;
}

TEST(BuzzDetector, FindsBuzzingAtItsEighthReversalAlongEachAxis) {
  for (const int axis : {0, 1, 2}) {
    EXPECT_EQ(CountReversals(5, 0.05, 1, axis), 8) << axis;
    EXPECT_EQ(CountReversals(20, 0.05, 1, axis), 8) << axis;
  }
}

// Eight reversals are seven swings apart: of 22 ms they take 154 ms, of 24 ms more than the window.
TEST(BuzzDetector, LetsAHandTurnRoundAsFastAsItCan) {
  EXPECT_EQ(CountReversals(22, 0.05, 1), 8);
  EXPECT_EQ(CountReversals(24, 0.05, 1), 0);
  EXPECT_EQ(CountReversals(50, 1, 7), 0) << "10 Hz, a tremor";
}

TEST(BuzzDetector, LetsSwingsOfLittleSpeedOrForceBe) {
  const BuzzThresholds least;
  EXPECT_EQ(CountReversals(5, 0.99 * least.speed, 1), 0);
  EXPECT_EQ(CountReversals(5, 1.01 * least.speed, 1), 8);
  // From end to end the force changes by twice its size.
  EXPECT_EQ(CountReversals(5, 0.05, 0.49 * least.force), 0);
  EXPECT_EQ(CountReversals(5, 0.05, 0.51 * least.force), 8);
}

TEST(BuzzDetector, SwingsAlongDifferentAxesDoNotAddUp) {
  BuzzDetector detector({});
  for (int swing = 0; swing < 7; ++swing) {  // The first only begins: six reversals of each axis.
    const double sign = swing % 2 == 0 ? 1 : -1;
    EXPECT_FALSE(
        detector.Update(sign * Vec3(0.05, -0.05, 0.05), sign * Vec3(-1, 1, -1), kBuzzPeriod));
  }
}

TEST(BuzzDetector, ResetForgetsTheReversals) {
  BuzzDetector detector({});
  int found = 0;
  for (int swing = 0; swing < 40; ++swing) {
    const double sign = swing % 2 == 0 ? 1 : -1;
    found += detector.Update(Vec3(sign * 0.05, 0, 0), Vec3(-sign, 0, 0), kBuzzPeriod) ? 1 : 0;
    if (swing % 8 == 7) {
      detector.Reset();
    }
  }
  EXPECT_EQ(found, 0);
}

}  // namespace
}  // namespace hvas::haptics
