#include "simulation/first_parts.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "haptics/haptic_tick.h"
#include "simulation/simulation.h"
#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

constexpr std::size_t kBlockIndex = 0;
constexpr std::size_t kPegIndex = 1;
constexpr std::size_t kCollarIndex = 2;

using product::OccurrenceId;
using product::Product;
using SharedModel = std::shared_ptr<const Model>;

/** The models of the first parts, and the one of all parts. */
struct Compiled {
  std::vector<SharedModel> first;
  SharedModel whole;
};

Compiled CompileInStages(const Product& product, double least_gain_s) {
  Compiled compiled;
  CompileOptions options = testing::FastOptions();
  options.least_gain = std::chrono::duration<double>(least_gain_s);
  options.on_first_parts = [&](const SharedModel& model) { compiled.first.push_back(model); };
  Diagnostics diagnostics;
  const auto model = Compile(std::make_shared<Product>(product), options, &diagnostics);
  EXPECT_TRUE(model) << model.error().ToString();
  compiled.whole = model ? *model : nullptr;
  return compiled;
}

TEST(ChooseFirstPartsTest, TheyAreTheLargestAndWhatIsJoinedToItWithASmallMesh) {
  const Product product = testing::PegInBlockInCollar();
  const FirstParts first = ChooseFirstParts(product);
  EXPECT_EQ(first.parts, (std::vector{product.occurrences[kPegIndex].part,
                                      product.occurrences[kBlockIndex].part}));
  EXPECT_GT(first.share, 0);
  EXPECT_LT(first.share, 0.5);
}

TEST(ChooseFirstPartsTest, ThereAreNoneWhereTheOthersAreNoMoreWork) {
  EXPECT_TRUE(ChooseFirstParts(testing::PegInBlock()).parts.empty());
}

TEST(MakeBoxShapeTest, IsAsLargeAsThePart) {
  const Product product = testing::PegInBlock();
  for (const product::Part& part : product.parts) {
    const auto shape = MakeBoxShape(part);
    ASSERT_TRUE(shape) << shape.error().ToString();
    const double size = part.box_B.size().norm();
    EXPECT_LT(((*shape)->box_B().low - part.box_B.low).norm(), 1e-5 * size);
    EXPECT_LT(((*shape)->box_B().high - part.box_B.high).norm(), 1e-5 * size);
  }
}

TEST(CompileInStagesTest, TheFirstPartsCanBePutTogetherBeforeTheOthersAreReady) {
  const Compiled compiled = CompileInStages(testing::PegInBlockInCollar(), 0);
  ASSERT_EQ(compiled.first.size(), 1u);
  const Model& first = *compiled.first.front();
  EXPECT_EQ(CountPending(first), 1u);
  EXPECT_EQ(first.bodies[kCollarIndex].role, BodyRole::kPending);
  EXPECT_TRUE(first.sequence.gaps.empty());
  EXPECT_EQ(first.sequence.steps.front().occurrence,
            compiled.whole->sequence.steps.front().occurrence);
  ASSERT_EQ(first.sequence.steps.size(), 2u);
  EXPECT_EQ(first.sequence.steps[0].occurrence, OccurrenceId(kBlockIndex));
  EXPECT_EQ(first.sequence.steps[1].occurrence, OccurrenceId(kPegIndex));
  const auto is_fit_of_peg = [](const ModelMate& mate) { return mate.fit != nullptr; };
  EXPECT_TRUE(std::any_of(first.mates.begin(), first.mates.end(), is_fit_of_peg));
}

TEST(CompileInStagesTest, WhatIsPendingLiesThereAndCannotBeTaken) {
  const Compiled compiled = CompileInStages(testing::PegInBlockInCollar(), 0);
  ASSERT_EQ(compiled.first.size(), 1u);
  const Simulation simulation(compiled.first.front(), haptics::TickOptions());
  EXPECT_EQ(simulation.physics().placement(OccurrenceId(kCollarIndex)), Placement::kPending);
  EXPECT_EQ(simulation.physics().placement(OccurrenceId(kPegIndex)), Placement::kLoose);
}

TEST(CompileInStagesTest, TheWholeModelIsTheOneThatIsCompiledAtOnce) {
  const Product product = testing::PegInBlockInCollar();
  const Compiled in_stages = CompileInStages(product, 0);
  const Compiled at_once = CompileInStages(product, 1e9);
  EXPECT_TRUE(at_once.first.empty());
  EXPECT_EQ(CountPending(*in_stages.whole), 0u);
  ASSERT_EQ(in_stages.whole->bodies.size(), at_once.whole->bodies.size());
  for (std::size_t i = 0; i < at_once.whole->bodies.size(); ++i) {
    const Body& a = in_stages.whole->bodies[i];
    const Body& b = at_once.whole->bodies[i];
    EXPECT_EQ(a.X_WB_start.p(), b.X_WB_start.p());
    EXPECT_EQ(a.shape->point_count(), b.shape->point_count());
  }
  ASSERT_EQ(in_stages.whole->sequence.steps.size(), at_once.whole->sequence.steps.size());
  for (std::size_t i = 0; i < at_once.whole->sequence.steps.size(); ++i) {
    EXPECT_EQ(in_stages.whole->sequence.steps[i].occurrence,
              at_once.whole->sequence.steps[i].occurrence);
  }
}

}  // namespace
}  // namespace hvas::simulation
