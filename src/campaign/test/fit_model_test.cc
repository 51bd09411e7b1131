// Products as made by the formulas of their fits.

#include "campaign/fit_model.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "mates/assignments.h"
#include "sequence/fit_of_mate.h"
#include "simulation/test/small_models.h"

namespace hvas::campaign {
namespace {

product::Product MakePegProduct(const char* fit) {
  product::Product product = simulation::testing::PegInBlock();
  EXPECT_TRUE(mates::AssignFit(&product, fit));
  return product;
}

Plan MakePressPlan(double press_force) {
  Plan plan;
  plan.sizes.push_back({"default", {}, 1.33, 1, {}, {}, {}, {}});
  plan.press_force = press_force;
  return plan;
}

RunResult MakeProduct(const FitModel& model, const Plan& plan, std::uint64_t seed) {
  std::vector<std::uint64_t> values(model.factors().size());
  model.DrawFactors(seed, values);
  std::vector<MadeFit> made;
  for (std::size_t i = 0; i < model.mates().size(); ++i) {
    made.push_back(model.CalcFit(i, values));
  }
  return model.Judge(made, plan);
}

TEST(FitModel, AProductHasTheFitsThatASimulationDrawsForTheSeed) {
  const product::Product product = MakePegProduct("all=H7/p6");
  const Plan plan = MakePressPlan(0);
  Diagnostics diagnostics;
  const auto model = FitModel::Make(product, plan.sizes[0], &diagnostics);
  ASSERT_TRUE(model) << model.error().ToString();
  ASSERT_EQ(model->mates().size(), 1U);
  EXPECT_EQ(model->factors().size(), 3U);  // Hole, shaft and surface.
  const product::Mate& mate = product.mates[model->mates()[0].id.index()];
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto force =
        sequence::MakeFitForce(product, mate, seed, fits::PairChoice::kAny, &diagnostics);
    ASSERT_NE(force, nullptr);
    const RunResult made = MakeProduct(*model, plan, seed);
    EXPECT_EQ(made.force, force->max_resistance());  // To the bit.
    EXPECT_EQ(made.clearance, 2 * force->mean_clearance());
    EXPECT_EQ(made.pressure_share, force->max_pressure() / force->elastic_limit());
    EXPECT_TRUE(made.is_complete);
  }
}

TEST(FitModel, DrawnConditionsGiveTheSameFitAgain) {
  const product::Product product = MakePegProduct("all=H7/s6");
  SizeVariant sizes;
  sizes.spread = Spread::kUniform;
  sizes.friction = UniformRange{0.05, 0.25};
  sizes.roughness = UniformRange{1e-6, 5e-6};
  Diagnostics diagnostics;
  const auto model = FitModel::Make(product, sizes, &diagnostics);
  ASSERT_TRUE(model) << model.error().ToString();
  EXPECT_EQ(model->factors().size(), 5U);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    product::Product made = product;
    SetDrawnConditions(*model, seed, sizes, &made);
    const product::Mate& mate = made.mates[model->mates()[0].id.index()];
    const auto force =
        sequence::MakeFitForce(made, mate, seed, fits::PairChoice::kAny, &diagnostics);
    ASSERT_NE(force, nullptr);
    const double expected = MakeProduct(*model, MakePressPlan(0), seed).force;
    EXPECT_NEAR(force->max_resistance(), expected, 1e-9 * expected);
  }
}

TEST(FitModel, ThePressAndTheElasticLimitDecide) {
  const product::Product product = MakePegProduct("all=H7/s6");
  Plan plan = MakePressPlan(0);
  Diagnostics diagnostics;
  const auto model = FitModel::Make(product, plan.sizes[0], &diagnostics);
  ASSERT_TRUE(model);
  const RunResult free = MakeProduct(*model, plan, 7);
  ASSERT_GT(free.force, 0);
  plan.press_force = 0.5 * free.force;
  const RunResult pressed = MakeProduct(*model, plan, 7);
  EXPECT_FALSE(pressed.is_complete);
  EXPECT_NEAR(pressed.utilisation, std::max(2.0, free.pressure_share), 1e-12);
  EXPECT_EQ(pressed.entity, model->mates()[0].id.value());
  plan.press_force = 2 * free.force;
  EXPECT_TRUE(MakeProduct(*model, plan, 7).is_complete);
  std::vector<MadeFit> yielding{{1, -1e-5, 1.5}};
  EXPECT_TRUE(model->Judge(yielding, plan).is_complete);
  EXPECT_EQ(model->Judge(yielding, plan).cause, Cause::kYield);
  plan.may_yield = false;
  EXPECT_FALSE(model->Judge(yielding, plan).is_complete);
}

}  // namespace
}  // namespace hvas::campaign
