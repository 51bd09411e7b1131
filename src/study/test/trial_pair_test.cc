// Pairs of the trials of a study (W1, W6, W8, W12).

#include "study/trial_pair.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fits/pair_choice.h"
#include "study/test/tiny_study.h"

namespace hvas::study {
namespace {

Condition MakeCondition(const std::string& fit) {
  Condition condition;
  condition.id = "x";
  condition.fit = fit;
  return condition;
}

std::shared_ptr<const simulation::Model> MakeModel(const Condition& condition) {
  auto model = testing::PegModel(condition);
  EXPECT_TRUE(model) << model.error().ToString();
  return *model;
}

std::size_t FindStep(const simulation::Model& model) {
  return *FindPartStep(model, "peg");
}

TEST(TrialPairTest, W1EveryTrialHasASurfaceOfItsOwnThatItsSeedRepeats) {
  const Condition condition = MakeCondition("H7/k6");
  const auto model = MakeModel(condition);
  const std::size_t step = FindStep(*model);
  std::vector<std::vector<double>> surfaces;
  for (std::size_t trial = 0; trial < 20; ++trial) {
    const std::uint64_t seed = CalcPairSeed(5, 3, trial);
    const auto drawn = DrawPair(*model, step, condition, seed);
    ASSERT_TRUE(drawn) << drawn.error().ToString();
    const TrialPair pair = *DescribePair(**drawn, step);
    EXPECT_TRUE(fits::ShowsKind(pair.clearances, fits::FitKind::kTransition)) << trial;
    EXPECT_EQ(std::count(surfaces.begin(), surfaces.end(), pair.clearances), 0) << trial;
    surfaces.push_back(pair.clearances);
    EXPECT_EQ(DescribePair(**DrawPair(*model, step, condition, seed), step)->clearances,
              pair.clearances);
  }
  EXPECT_NE(CalcPairSeed(5, 3, 1), CalcPairSeed(5, 1, 3));
  EXPECT_NE(CalcPairSeed(5, 3, 1), CalcPairSeed(6, 3, 1));
}

TEST(TrialPairTest, DrawnModelIsTheOneThatItsSeedCompiles) {
  const Condition condition = MakeCondition("H7/g6");
  const auto model = MakeModel(condition);
  const auto drawn = *DrawPair(*model, FindStep(*model), condition, 77);
  simulation::CompileOptions options = simulation::testing::FastOptions();
  options.seed = 77;
  Diagnostics diagnostics;
  const auto compiled = *simulation::Compile(model->product, options, &diagnostics);
  ASSERT_EQ(drawn->mates.size(), compiled->mates.size());
  for (std::size_t i = 0; i < drawn->mates.size(); ++i) {
    ASSERT_EQ(drawn->mates[i].fit == nullptr, compiled->mates[i].fit == nullptr);
    if (drawn->mates[i].fit != nullptr) {
      EXPECT_TRUE(std::ranges::equal(drawn->mates[i].fit->clearances(),
                                     compiled->mates[i].fit->clearances()));
    }
  }
  EXPECT_EQ(drawn->seed, compiled->seed);
  for (std::size_t i = 0; i < drawn->bodies.size(); ++i) {
    EXPECT_EQ(drawn->bodies[i].faces == nullptr, compiled->bodies[i].faces == nullptr) << i;
  }
}

TEST(TrialPairTest, W12ObserverIsShownWhatTheModelHas) {
  const Condition condition = MakeCondition("H7/p6");
  const auto model = MakeModel(condition);
  const std::size_t step = FindStep(*model);
  const auto drawn = *DrawPair(*model, step, condition, 9);
  const ShownPair shown = FindShownPair(*drawn, step);
  EXPECT_EQ(shown.fit, drawn->mates[FindFittedMate(*drawn, step)->index()].fit);
  EXPECT_EQ(shown.kind, fits::FitKind::kInterference);
  // Its training shows pairs of the same kind.
  const auto trained = MakePairSource(model, step, condition)(9);
  EXPECT_TRUE(std::ranges::equal(trained.fit->clearances(), shown.fit->clearances()));
}

TEST(ApplyFitTest, W8MeasuredSizesOutsideTheFitAreRefused) {
  Condition condition = MakeCondition("H7/g6");
  condition.sizes.hole_diameters = {{0, 10.030e-3}};  // 10 H7 ends at 10.015 mm
  const auto refused = testing::PegModel(condition);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("10.0300 mm"), std::string::npos)
      << refused.error().ToString();
  EXPECT_NE(refused.error().message.find("10.0150"), std::string::npos);
  EXPECT_NE(refused.error().where.find("condition x"), std::string::npos);
  condition.sizes.hole_diameters = {{0, 10.002e-3}, {20e-3, 10.015e-3}};
  EXPECT_TRUE(testing::PegModel(condition));
}

TEST(ApplyFitTest, W8ConditionAndSideFileMustNotDiffer) {
  product::Product product = simulation::testing::PegInBlock();
  for (product::Mate& mate : product.mates) {
    if (mate.kind == product::MateKind::kAxisHole) {
      mate.conditions.friction = 0.2;  // as a side file states it
    }
  }
  Condition condition = MakeCondition("H7/g6");
  condition.sizes.friction = 0.15;
  const auto refused = ApplyFit(condition, "peg", &product);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("friction"), std::string::npos);
  condition.sizes.friction = 0.2;
  EXPECT_TRUE(ApplyFit(condition, "peg", &product));
}

TEST(TrialPairTest, ConditionWhoseKindNoPairShowsIsRefused) {
  Condition condition = MakeCondition("H7/g6");
  condition.sizes.hole_roughness = condition.sizes.shaft_roughness = 400e-6;
  const auto model = MakeModel(condition);
  const auto drawn = DrawPair(*model, FindStep(*model), condition, 1);
  ASSERT_FALSE(drawn);
  EXPECT_NE(drawn.error().message.find("1000 pairs"), std::string::npos);
  EXPECT_NE(drawn.error().where.find("condition x"), std::string::npos);
}

TEST(MakeFitKeyTest, DiffersWithEverythingThatApplyFitSets) {
  Condition condition = MakeCondition("H7/g6");
  std::set<std::string> keys{MakeFitKey(condition, "peg")};
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "pin")).second);
  condition.fit = "H7/p6";
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.friction = 0.2;
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.hole_diameters = {{0, 0.01}};
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.hole_diameters = {{0.001, 0.01}};
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.shaft_diameters = {{0, 0.01}};
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.hole_roughness = 1e-6;
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
  condition.sizes.shaft_roughness = 1e-6;
  EXPECT_TRUE(keys.insert(MakeFitKey(condition, "peg")).second);
}

}  // namespace
}  // namespace hvas::study
