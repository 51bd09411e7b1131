#include "sequence/thread_way.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::sequence {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/** A nut 6 mm high whose place is 2 mm above the foot of a bolt of 20 mm along z, in the hand. */
haptics::HeldPart MakeNut(double lead, double preload) {
  haptics::HeldMate mate;
  mate.capture = {product::MateKind::kAxisHole, 0, 20e-3, 0, 6e-3, 0};
  mate.radius = 4e-3;
  mate.has_shaft = false;
  mate.thread.emplace();
  mate.thread->lead = lead;
  mate.thread->preload = preload;
  mate.thread->stiffness = preload > 0 ? 1e8 : 0;
  haptics::HeldPart part;
  part.mates = {mate};
  part.X_WB_goal = spatial::Pose(Vec3(0, 0, 2e-3));
  part.insertion_W = -Vec3::UnitZ();
  return part;
}

TEST(ThreadWay, IsTheHelixUntilTheThreadIsOut) {
  for (const double lead : {1.25e-3, -1.25e-3}) {
    const haptics::HeldPart nut = MakeNut(lead, 0);
    const paths::Path way = MakeThreadWay(nut, 3e-3);
    ASSERT_GT(way.size(), 24U * 14);
    double turned = 0;
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
      const Vec3 turn = spatial::RotationBetween(way[i - 1].q(), way[i].q());
      EXPECT_NEAR(turn.head<2>().norm(), 0, 1e-12);
      turned += turn.z();
      EXPECT_NEAR(way[i].p().z() - 2e-3, std::abs(lead) * std::abs(turned) / kTurn, 1e-9);
    }
    EXPECT_NEAR(turned / kTurn, 18e-3 / lead, 1e-6);
    EXPECT_NEAR(way.back().p().z(), 30e-3, 1e-9);  // Straight on from there.
  }
}

TEST(ThreadWay, BeginsByLooseningTheHead) {
  const haptics::HeldPart nut = MakeNut(1.25e-3, 10e3);
  const paths::Path way = MakeThreadWay(nut, 0);
  const double head = 10e3 / (1e8 * 1.25e-3 / kTurn);
  double turned = 0;
  std::size_t i = 1;
  for (; i < way.size() && way[i].p().z() <= 2e-3 + 1e-9; ++i) {
    turned += spatial::RotationBetween(way[i - 1].q(), way[i].q()).z();
  }
  EXPECT_GT(i, 1U);
  EXPECT_LE(turned, head);
  EXPECT_GT(turned, head - kTurn / 20);
}

TEST(ThreadWay, IsEmptyWithoutAThread) {
  haptics::HeldPart nut = MakeNut(1e-3, 0);
  nut.mates[0].thread.reset();
  EXPECT_TRUE(MakeThreadWay(nut, 1e-3).empty());
}

}  // namespace
}  // namespace hvas::sequence
