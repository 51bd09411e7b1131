#include "statics/least_holds.h"

#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "statics/test/blocks.h"

namespace hvas::statics {
namespace {

using testing::AddRectangle;

LeastHolds Find(const StaticProblem& problem, const StaticOptions& options = {}) {
  auto found = FindLeastHolds(problem, options);
  EXPECT_TRUE(found) << (found ? "" : found.error().ToString());
  return found ? *found : LeastHolds();
}

bool StandsWith(StaticProblem problem, unsigned held) {
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    problem.bodies[i].is_fixed = problem.bodies[i].is_fixed || (held >> i & 1U) != 0;
  }
  return SolveEquilibrium(problem)->stands;
}

TEST(LeastHolds, WhatStandsNeedsNone) {
  StaticProblem problem;
  problem.bodies.push_back({1, Vec3(0, 0, 0.1)});
  AddRectangle(&problem, 0, kGround, -1, 1, -1, 1, 0, 0.1);
  const LeastHolds found = Find(problem);
  EXPECT_TRUE(found.bodies.empty());
  EXPECT_TRUE(found.is_proven);
}

TEST(LeastHolds, LoosePartsNeedAHoldEach) {
  StaticProblem problem;
  for (int i = 0; i < 40; ++i) {
    problem.bodies.push_back({1.0 + i, Vec3(i, 0, 0)});
  }
  const LeastHolds found = Find(problem);
  EXPECT_EQ(found.bodies.size(), 40U);
  EXPECT_EQ(found.least, 40);
  EXPECT_TRUE(found.is_proven);
  EXPECT_LE(found.programmes, 2);
}

TEST(LeastHolds, ATowerThatTipsNeedsOne) {
  // The first stands, the second tips on it, and the others stand on the second. A hold of the
  // second suffices, or one above that presses on its other side.
  StaticProblem problem;
  for (int i = 0; i < 6; ++i) {
    problem.bodies.push_back({1, Vec3(i == 0 ? 0 : 0.5, 0, i + 0.5)});
    AddRectangle(&problem, i, i - 1, i == 1 ? -0.4 : problem.bodies.back().p_WC.x() - 0.4,
                 i == 1 ? 0.4 : problem.bodies.back().p_WC.x() + 0.4, -0.4, 0.4, i, 0.3);
  }
  const LeastHolds found = Find(problem);
  ASSERT_EQ(found.bodies.size(), 1U);
  EXPECT_TRUE(found.is_proven);
  EXPECT_TRUE(StandsWith(problem, 1U << static_cast<unsigned>(found.bodies.front())));
  EXPECT_TRUE(StandsWith(problem, 1U << 1U));
  EXPECT_FALSE(StandsWith(problem, 1U << 0U));
}

TEST(LeastHolds, OfTwoCardsOneIsHeld) {
  StaticProblem problem;
  for (const double side : {-1.0, 1.0}) {
    const int card = side < 0 ? 0 : 1;
    problem.bodies.push_back({1, Vec3(side * 0.5, 0, 0.5)});
    for (const double y : {-0.3, 0.3}) {
      problem.contacts.push_back({card, kGround, Vec3(side, y, 0), Vec3::UnitZ(), 0});
    }
  }
  for (const double y : {-0.3, 0.3}) {
    problem.contacts.push_back({0, 1, Vec3(0, y, 1), -Vec3::UnitX(), 0});
  }
  // Without friction the other one still slides away.
  EXPECT_EQ(Find(problem).bodies, std::vector<int>({0, 1}));
  for (StaticContact& contact : problem.contacts) {
    contact.friction = 0.45;  // Below 1 / (2 tan 45), and enough with a wall: 0.414.
  }
  const LeastHolds found = Find(problem);
  EXPECT_EQ(found.bodies.size(), 1U);
  EXPECT_TRUE(found.is_proven);
}

TEST(LeastHolds, AreThoseOfASearchOverAllSubsets) {
  int several = 0;
  for (std::uint32_t seed = 1000; seed < 1120; ++seed) {
    const StaticProblem problem = testing::MakeRandom(seed, 2 + static_cast<int>(seed % 5));
    const auto subsets = 1U << problem.bodies.size();
    int least = static_cast<int>(problem.bodies.size());
    for (unsigned held = 0; held < subsets; ++held) {
      if (std::popcount(held) < least && StandsWith(problem, held)) {
        least = std::popcount(held);
      }
    }
    const LeastHolds found = Find(problem);
    SCOPED_TRACE(seed);
    EXPECT_TRUE(found.is_proven);
    EXPECT_EQ(found.least, least);
    EXPECT_EQ(static_cast<int>(found.bodies.size()), least);
    unsigned held = 0;
    for (const int body : found.bodies) {
      held |= 1U << static_cast<unsigned>(body);
    }
    EXPECT_TRUE(StandsWith(problem, held));
    several += least > 1 ? 1 : 0;
  }
  EXPECT_GT(several, 20);
}

TEST(LeastHolds, WithoutProgrammesLeftTheyAreEnoughAndNoneIsInVain) {
  int more = 0;
  for (std::uint32_t seed = 1000; seed < 1120; ++seed) {
    const StaticProblem problem = testing::MakeRandom(seed, 2 + static_cast<int>(seed % 5));
    StaticOptions options;
    options.most_programmes = 1;
    const LeastHolds found = Find(problem, options);
    SCOPED_TRACE(seed);
    unsigned held = 0;
    for (const int body : found.bodies) {
      held |= 1U << static_cast<unsigned>(body);
    }
    EXPECT_TRUE(StandsWith(problem, held));
    for (const int body : found.bodies) {
      EXPECT_FALSE(StandsWith(problem, held & ~(1U << static_cast<unsigned>(body))));
    }
    EXPECT_LE(found.least, static_cast<int>(found.bodies.size()));
    more += found.is_proven ? 0 : 1;
  }
  EXPECT_GT(more, 0);
}

}  // namespace
}  // namespace hvas::statics
