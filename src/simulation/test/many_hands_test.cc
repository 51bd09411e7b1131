// More than two hands in one scene: X3, X4, X7, N9.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "simulation/executors.h"
#include "simulation/test/moved_hands.h"
#include "simulation/tick_log.h"

namespace hvas::simulation {
namespace {

using testing::kHalf;
using testing::MovedHands;
using testing::OccurrenceId;

/** Whoever holds the middle one of three blocks, with the others to its left and right. */
struct Row {
  std::size_t middle, left, right;
};

class ManyHandsTest : public ::testing::TestWithParam<Row> {};

// X7: the order in which the hands tick, and who solves which contact, is not felt.
TEST_P(ManyHandsTest, BlockBetweenTwoOthersIsPushedFromBothSides) {
  const auto [middle, left, right] = GetParam();
  MovedHands hands(testing::MakeBlocks(3), 3);
  for (std::size_t hand = 0; hand < 3; ++hand) {
    hands.Take(hand, OccurrenceId(hand));
    ASSERT_EQ(hands.simulation.physics().placement(OccurrenceId(hand)), Placement::kHeld);
  }
  hands.Run(1.0, std::vector(3, Vec3(0, 0, 0.1)));
  const double beside = 2 * kHalf + 5e-3;
  const auto bring = [&](std::size_t hand, double x) {
    // Over the others, and down beside the middle one.
    std::vector<Vec3> v(3, Vec3::Zero());
    v[hand] = Vec3(0, 0, 0.1);
    hands.Run(1.0, v);
    const Vec3 p_to = hands.states[middle].X_DH.p() + Vec3(x, 0, 0.1);
    v[hand] = p_to - hands.states[hand].X_DH.p();
    hands.Run(1.0, v);
    v[hand] = Vec3(0, 0, -0.1);
    hands.Run(1.0, v);
  };
  bring(left, -beside);
  bring(right, beside);
  hands.Run(0.3);
  for (const haptics::TickOutput& out : hands.out) {
    EXPECT_EQ(out.contact_count, 0);
  }
  std::vector<Vec3> v(3, Vec3::Zero());
  v[left].x() = 0.1;
  v[right].x() = -0.1;
  hands.Run(0.08, v);  // 3 mm beyond the first touch on either side
  hands.Run(1.0);
  // The middle one stays, so that the couplings of the outer ones bear all of it.
  const double expected = haptics::CouplingGains().k_lin * 3e-3;
  EXPECT_NEAR(hands.out[left].F_felt_W.f.x(), -expected, 0.005 * expected);
  EXPECT_NEAR(hands.out[right].F_felt_W.f.x(), expected, 0.005 * expected);
  EXPECT_NEAR(hands.out[middle].F_felt_W.f.x(), 0, 0.005 * expected);
  EXPECT_EQ(hands.out[left].contact_body.index(), middle);
  EXPECT_EQ(hands.out[right].contact_body.index(), middle);
  EXPECT_GT(hands.out[middle].contact_count, 4) << "on both of its sides";
  for (const testing::Watch& watch : hands.watches) {
    EXPECT_LE(watch.deepest, 0.3e-3) << "docs/limits.md";
    EXPECT_TRUE(watch.is_finite);
  }
  // All three go on together.
  hands.Run(0.5, std::vector(3, Vec3(0.05, 0, 0)));
  EXPECT_NEAR(hands.out[middle].F_felt_W.f.x(), 0, 0.05 * expected);
  EXPECT_NEAR(hands.out[left].F_felt_W.f.x(), -expected, 0.05 * expected);
}

INSTANTIATE_TEST_SUITE_P(Orders, ManyHandsTest,
                         ::testing::Values(Row{0, 1, 2}, Row{1, 0, 2}, Row{2, 1, 0}));

// N9: eight people move at random among each other, and every tick runs again.
TEST(EightHandsTest, RandomHandlingStaysSafeAndRunsAgain) {
  constexpr std::size_t kHands = haptics::kMaxHands;
  const auto model = testing::MakeBlocks(kHands);
  MovedHands hands(model, kHands);
  TickLog log(200'000);
  hands.simulation.KeepLog(&log);
  for (std::size_t hand = 0; hand < kHands; ++hand) {
    hands.Take(hand, OccurrenceId(hand));
  }
  hands.Run(1.0, std::vector(kHands, Vec3(0, 0, 0.1)));
  Random random(1);
  const Vec3 p_centre = hands.states[0].X_DH.p();
  std::size_t touching = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<Vec3> v;
    for (const device::DeviceState& state : hands.states) {
      const Vec3 p_to = p_centre + 0.06 * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1),
                                               random.Uniform(-1, 1));
      Vec3 wanted = (p_to - state.X_DH.p()) / 0.1;
      wanted *= std::min(1.0, 0.3 / std::max(1e-9, wanted.norm()));
      v.push_back(wanted);
    }
    hands.Run(0.1, v);
    touching += static_cast<std::size_t>(std::count_if(
        hands.out.begin(), hands.out.end(),
        [](const haptics::TickOutput& out) { return out.contact_count > 0; }));
  }
  EXPECT_GT(touching, 60u) << "the blocks have to meet for this to be a test";
  for (std::size_t hand = 0; hand < kHands; ++hand) {
    EXPECT_TRUE(hands.watches[hand].is_finite) << hand;
    EXPECT_LE(hands.watches[hand].deepest, 1.5e-3) << "docs/limits.md";
    EXPECT_LE(hands.watches[hand].largest_force,
              hands.simulation.options(hand).device.max_force + 1e-9);
  }
  Simulation again(model, std::vector<haptics::TickOptions>(kHands));
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    ASSERT_EQ(again.haptics().ReplayTick(log, i).F_H_D.f, log.tick(i).F_H_D.f) << i;
  }
}

}  // namespace
}  // namespace hvas::simulation
