#include "dynamics/hull.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::dynamics {
namespace {

Vec3 RandomDirection(Random* random) {
  const double x = random->Normal();
  const double y = random->Normal();
  return Vec3(x, y, random->Normal()).normalized();
}

double Support(std::span<const Vec3> points, const Vec3& direction) {
  double support = points[0].dot(direction);
  for (const Vec3& p : points) {
    support = std::max(support, p.dot(direction));
  }
  return support;
}

TEST(SelectSpread, KeepsFewPointsAsTheyAre) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(SelectSpread(points, 64), points);
}

TEST(SelectSpread, KeepsTheCornersOfABoxAmongPointsOfItsFaces) {
  Random random(41);
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) {
    Vec3 p(random.Uniform(-1, 1), random.Uniform(-2, 2), random.Uniform(-3, 3));
    p[i % 3] = std::copysign(1.0 + i % 3, p[i % 3]);
    points.push_back(p);
  }
  for (int i = 0; i < 8; ++i) {
    points.insert(points.begin() + 200 * i,
                  Vec3((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 2 : -2, (i & 4) != 0 ? 3 : -3));
  }
  const std::vector<Vec3> chosen = SelectSpread(points, 64);
  EXPECT_EQ(chosen.size(), 64u);
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = RandomDirection(&random);
    EXPECT_DOUBLE_EQ(Support(chosen, direction), Support(points, direction));
  }
}

// A prism of 32 sides in a circle of radius r lacks r (1 - cos(pi / 32)) = 0.5 % of it at most;
// with points left to the choice it is allowed twice that.
TEST(SelectSpread, KeepsACylinderRound) {
  Random random(42);
  std::vector<Vec3> points;
  for (int i = 0; i < 720; ++i) {
    const double angle = std::numbers::pi * i / 360;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    points.emplace_back(std::cos(angle), std::sin(angle), 2);
  }
  const std::vector<Vec3> chosen = SelectSpread(points, 64);
  EXPECT_EQ(chosen.size(), 64u);
  for (int i = 0; i < 500; ++i) {
    const Vec3 direction = RandomDirection(&random);
    const double lacking = Support(points, direction) - Support(chosen, direction);
    EXPECT_GE(lacking, 0);
    EXPECT_LT(lacking, 0.02);
  }
}

TEST(SelectSpread, StopsWhenAllThatIsLeftAreCopies) {
  std::vector<Vec3> points(200, Vec3(1, 2, 3));
  points.emplace_back(0, 0, 0);
  EXPECT_EQ(SelectSpread(points, 64).size(), 2u);
}

}  // namespace
}  // namespace hvas::dynamics
