#include "spatial/box.h"

#include <gtest/gtest.h>

#include "spatial/test/random_pose.h"

namespace hvas::spatial {
namespace {

Vec3 Corner(const Box& box, int i) {
  return {(i & 1) != 0 ? box.high.x() : box.low.x(), (i & 2) != 0 ? box.high.y() : box.low.y(),
          (i & 4) != 0 ? box.high.z() : box.low.z()};
}

TEST(Box, GrowsFromEmptyToWhatWasAdded) {
  Box box;
  EXPECT_TRUE(box.is_empty());
  EXPECT_FALSE(box.Contains(Vec3::Zero()));
  box.Add(Vec3(1, 2, 3));
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.size(), Vec3::Zero());
  box.Add(Box{{-1, 0, 0}, {0, 1, 1}});
  EXPECT_EQ(box.low, Vec3(-1, 0, 0));
  EXPECT_EQ(box.high, Vec3(1, 2, 3));
  EXPECT_EQ(box.centre(), Vec3(0, 1, 1.5));
  Box same = box;
  same.Add(Box());
  EXPECT_EQ(same.low, box.low);
  EXPECT_EQ(same.high, box.high);
  EXPECT_EQ(box.Expanded(0.5).size(), Vec3(3, 3, 4));
}

TEST(Box, OverlapsWhenAllThreeIntervalsDo) {
  const Box unit{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(unit.Overlaps(unit));
  EXPECT_TRUE(unit.Overlaps({{1, 1, 1}, {2, 2, 2}})) << "touching counts";
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 shift = 1.001 * Vec3::Unit(axis);
    EXPECT_FALSE(unit.Overlaps({unit.low + shift, unit.high + shift}));
    EXPECT_FALSE(unit.Overlaps({unit.low - shift, unit.high - shift}));
  }
  EXPECT_FALSE(unit.Overlaps(Box()));
  EXPECT_TRUE(unit.Contains(Vec3(1, 0, 0.5)));
  EXPECT_FALSE(unit.Contains(Vec3(0.5, 1.001, 0.5)));
}

// The tightest box around the eight turned corners, found by turning them.
TEST(BoxTransform, IsTheBoxAroundTheTurnedCorners) {
  Random random(21);
  for (int i = 0; i < 500; ++i) {
    const Pose X_AB = RandomPose(&random, 2);
    Box box_B;
    box_B.Add(RandomVector(&random, 1));
    box_B.Add(RandomVector(&random, 1));
    Box expected;
    for (int corner = 0; corner < 8; ++corner) {
      expected.Add(X_AB * Corner(box_B, corner));
    }
    const Box box_A = Transform(X_AB, box_B);
    EXPECT_LT((box_A.low - expected.low).norm(), 1e-14);
    EXPECT_LT((box_A.high - expected.high).norm(), 1e-14);
  }
}

TEST(BoxTransform, KeepsEmptyEmpty) {
  EXPECT_TRUE(Transform(Pose(Vec3(1, 2, 3)), Box()).is_empty());
}

}  // namespace
}  // namespace hvas::spatial
