// More than two hands in one scene: X3, X4, X7, N9.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "person/test/moved_hands.h"
#include "simulation/executors.h"
#include "simulation/tick_log.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using testing::kHalf;
using testing::MovedHands;

/** Whoever holds the middle one of three blocks, with the others to its left and right. */
struct Row {
  std::size_t middle, left, right;
};

class ManyHandsTest : public ::testing::TestWithParam<Row> {};

// X7: the order in which the hands tick, and who solves which contact, is not felt.
TEST_P(ManyHandsTest, BlockBetweenTwoOthersIsPushedFromBothSides) {
  const std::size_t middle = GetParam().middle;
  const std::size_t left = GetParam().left;
  const std::size_t right = GetParam().right;
  MovedHands hands(testing::MakeBlocks(3), 3);
  for (std::size_t hand = 0; hand < 3; ++hand) {
    hands.Take(hand, OccurrenceId(hand));
    ASSERT_EQ(hands.simulation.physics().placement(OccurrenceId(hand)),
              simulation::Placement::kHeld);
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

/** Two hands at one block, 10 cm above the table. */
struct TwoAtOnePart : MovedHands {
  TwoAtOnePart() : MovedHands(testing::MakeBlocks(2), 2) {
    Take(0, OccurrenceId(0));
    Run(1.0, {Vec3(0, 0, 0.1)});
    Run(0.3);
    Help(1, 0);
  }
};

// X1: what either hand pulls, the other one bears.
TEST(SharedHoldTest, HandsAtOnePartFeelEachOther) {
  TwoAtOnePart hands;
  EXPECT_EQ(hands.out[1].occurrence, OccurrenceId(0));
  EXPECT_LT(hands.out[1].F_felt_W.f.norm(), 0.05) << "it was gripped where the hand was";
  hands.Run(0.1, {Vec3(-0.02, 0, 0), Vec3(0.02, 0, 0)});
  hands.Run(0.5);
  const double expected = haptics::CouplingGains().k_lin * 2e-3;
  EXPECT_NEAR(hands.out[0].F_felt_W.f.x(), expected, 0.01 * expected);
  EXPECT_NEAR(hands.out[1].F_felt_W.f.x(), -expected, 0.01 * expected);
  // Each bears half of the weight when the first hand goes down by as much as it hung below it.
  const double weight = hands.out[0].F_felt_W.f.z() + hands.out[1].F_felt_W.f.z();
  hands.Run(0.1, {Vec3(0, 0, -0.01)});
  hands.Run(0.5);
  EXPECT_NEAR(hands.out[0].F_felt_W.f.z() + hands.out[1].F_felt_W.f.z(), weight, 0.01);
  EXPECT_LT(hands.out[1].F_felt_W.f.z(), -0.3) << "the second hand bears the first one's push";
}

TEST(SharedHoldTest, WhoHoldsOnHasThePartAloneWhenTheOtherOneLetsGo) {
  TwoAtOnePart hands;
  hands.states[1].is_gripping = false;
  hands.Run(0.1);
  EXPECT_FALSE(hands.out[1].occurrence.is_valid());
  EXPECT_EQ(hands.out[0].occurrence, OccurrenceId(0)) << "the helper has let go";
  hands.Help(1, 0);
  const double height = hands.out[0].X_WD.p().z();
  hands.states[0].is_gripping = false;
  hands.Run(0.5);
  EXPECT_FALSE(hands.out[0].occurrence.is_valid());
  EXPECT_EQ(hands.out[1].occurrence, OccurrenceId(0));
  EXPECT_EQ(hands.simulation.physics().placement(OccurrenceId(0)), simulation::Placement::kHeld);
  EXPECT_GT(hands.out[1].X_WD.p().z(), height - 0.01) << "it has not fallen";
}

TEST(SharedHoldTest, OutOfReachOrWithoutAPartThereIsNothingToHold) {
  MovedHands hands(testing::MakeBlocks(2), 2);
  hands.simulation.physics().PrepareHelp(0, 1);
  hands.PutHand(1, Vec3(0.3, 0.3, 0.3));
  hands.Run(0.05);
  hands.states[1].is_gripping = true;
  hands.Run(0.1);
  EXPECT_FALSE(hands.out[1].occurrence.is_valid());
  hands.states[1].is_gripping = false;
  hands.Run(0.05);
  hands.Take(0, OccurrenceId(0));
  hands.simulation.physics().PrepareHelp(0, 1);
  hands.states[1].is_gripping = true;
  hands.Run(0.1);
  EXPECT_FALSE(hands.out[1].occurrence.is_valid()) << "it is 40 cm away";
}

TEST(SharedHoldTest, RandomHandlingByTwoStaysSafeAndRunsAgain) {
  const auto model = testing::MakeBlocks(2);
  MovedHands hands(model, 2);
  simulation::TickLog log(100'000);
  hands.simulation.KeepLog(&log);
  hands.Take(0, OccurrenceId(0));
  hands.Run(1.0, {Vec3(0, 0, 0.1)});
  hands.Help(1, 0);
  Random random(2);
  const std::array p_first{hands.states[0].X_DH.p(), hands.states[1].X_DH.p()};
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> v;
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const Vec3 p_to = p_first[hand] + 0.01 * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1),
                                                    random.Uniform(-1, 1));
      v.push_back((p_to - hands.states[hand].X_DH.p()) / 0.1);
    }
    hands.Run(0.1, v);
  }
  hands.Run(0.5);
  for (std::size_t hand = 0; hand < 2; ++hand) {
    EXPECT_TRUE(hands.watches[hand].is_finite);
    EXPECT_EQ(hands.out[hand].occurrence, OccurrenceId(0)) << "both still hold it";
    EXPECT_LE(hands.watches[hand].largest_force,
              hands.simulation.options(hand).device.max_force + 1e-9);
  }
  // At rest the two springs and the weight balance.
  const Vec3 sum = hands.out[0].F_true_W.f + hands.out[1].F_true_W.f;
  EXPECT_LT(Vec3(sum.x(), sum.y(), 0).norm(), 1e-3);
  simulation::Simulation again(model, std::vector<haptics::TickOptions>(2));
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    ASSERT_EQ(again.haptics().ReplayTick(log, i).F_H_D.f, log.tick(i).F_H_D.f) << i;
  }
}

// N9: eight people move at random among each other, and every tick runs again.
TEST(EightHandsTest, RandomHandlingStaysSafeAndRunsAgain) {
  constexpr std::size_t kHands = haptics::kMaxHands;
  const auto model = testing::MakeBlocks(kHands);
  MovedHands hands(model, kHands);
  simulation::TickLog log(200'000);
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
    touching += static_cast<std::size_t>(
        std::count_if(hands.out.begin(), hands.out.end(),
                      [](const haptics::TickOutput& out) { return out.contact_count > 0; }));
  }
  EXPECT_GT(touching, 60u) << "the blocks have to meet for this to be a test";
  for (std::size_t hand = 0; hand < kHands; ++hand) {
    EXPECT_TRUE(hands.watches[hand].is_finite) << hand;
    EXPECT_LE(hands.watches[hand].deepest, 1.5e-3) << "docs/limits.md";
    EXPECT_LE(hands.watches[hand].largest_force,
              hands.simulation.options(hand).device.max_force + 1e-9);
  }
  simulation::Simulation again(model, std::vector<haptics::TickOptions>(kHands));
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    ASSERT_EQ(again.haptics().ReplayTick(log, i).F_H_D.f, log.tick(i).F_H_D.f) << i;
  }
}

}  // namespace
}  // namespace hvas::person
