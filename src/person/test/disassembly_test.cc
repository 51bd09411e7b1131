// Products are taken apart, and single parts got out of them, by simulated persons (X16).

#include <algorithm>

#include <gtest/gtest.h>

#include "person/simulated_person.h"
#include "person/test/session.h"
#include "simulation/disassembly_run.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Product;
using Names = std::vector<std::string>;
using ::testing::IsSubstring;

std::shared_ptr<const simulation::Model> CompiledModel(Product product) {
  Diagnostics diagnostics;
  auto model = simulation::Compile(std::make_shared<Product>(std::move(product)),
                                   simulation::testing::FastOptions(), &diagnostics);
  EXPECT_TRUE(model.has_value());
  return *model;
}

OccurrenceId Find(const simulation::Model& model, const std::string& name) {
  for (const product::Occurrence& occurrence : model.product->occurrences) {
    if (occurrence.name == name) {
      return occurrence.id;
    }
  }
  ADD_FAILURE() << name;
  return {};
}

simulation::DisassemblyPlan PlanFor(const simulation::Model& model, const std::string& name) {
  simulation::DisassemblyOptions options;
  options.target = Find(model, name);
  return simulation::PlanDisassembly(model, options);
}

Names OrderOf(const simulation::Model& model, const simulation::DisassemblyPlan& plan) {
  Names names;
  for (const simulation::Removal& removal : plan.removals) {
    names.push_back(model.product->occurrences[removal.step.occurrence.index()].name);
  }
  return names;
}

TEST(DisassemblyPlanTest, X16PartUnderALidWaitsForTheLid) {
  const auto model = CompiledModel(sequence::testing::CoinUnderLid());
  const simulation::DisassemblyPlan plan = PlanFor(*model, "coin");
  ASSERT_EQ(OrderOf(*model, plan), (Names{"lid", "coin"}));
  EXPECT_TRUE(plan.is_smallest);
  EXPECT_TRUE(plan.removals[0].waits_for.empty());
  ASSERT_EQ(plan.removals[1].waits_for.size(), 1u);
  const sequence::Obstacle& lid = plan.removals[1].waits_for[0];
  EXPECT_EQ(lid.occurrence, Find(*model, "lid"));
  // The coin is 10 mm high in a cup 20 mm deep.
  EXPECT_FALSE(lid.mate.is_valid());
  EXPECT_NEAR(lid.travelled, 10e-3, 0.5e-3);
  EXPECT_GT(plan.removals[1].step.extraction_W.z(), 0.999);
}

TEST(DisassemblyPlanTest, X16SearchThatIsEndedEarlyGivesASetAndReportsIt) {
  const auto model = CompiledModel(sequence::testing::CoinUnderLid());
  simulation::DisassemblyOptions options;
  options.target = Find(*model, "coin");
  options.max_sets = 0;
  const simulation::DisassemblyPlan plan = simulation::PlanDisassembly(*model, options);
  EXPECT_EQ(OrderOf(*model, plan), (Names{"lid", "coin"}));
  EXPECT_FALSE(plan.is_smallest);
}

TEST(DisassemblyPlanTest, X16PartsThatAreNotInTheWayStay) {
  const auto model = CompiledModel(sequence::testing::CappedCollarUnderClamp());
  // Taking all apart begins with the cap; the clamp does not need that.
  const simulation::DisassemblyPlan all = simulation::PlanDisassembly(*model, {});
  EXPECT_EQ(all.removals.size(), 3u);
  EXPECT_EQ(OrderOf(*model, PlanFor(*model, "clamp")), (Names{"clamp"}));
  const Names peg = OrderOf(*model, PlanFor(*model, "peg"));
  EXPECT_EQ(peg.size(), 3u);
  EXPECT_EQ(peg.back(), "peg");
}

TEST(DisassemblyPlanTest, X16PartThatCannotComeOutNamesWhatItMeets) {
  const auto model = CompiledModel(sequence::testing::CaptiveRing());
  const OccurrenceId base = sequence::FindBase(model->sequence);
  const OccurrenceId other(1 - base.index());
  simulation::DisassemblyOptions options;
  options.target = other;
  const simulation::DisassemblyPlan plan = simulation::PlanDisassembly(*model, options);
  EXPECT_TRUE(plan.removals.empty());
  ASSERT_EQ(plan.stuck.size(), 1u);
  EXPECT_PRED_FORMAT2(IsSubstring, "the base, which stays in the fixture", plan.stuck[0].reason);
  EXPECT_PRED_FORMAT2(IsSubstring, "does not pass", plan.stuck[0].reason);
}

/** A disassembly by a simulated person. */
struct Disassembly {
  explicit Disassembly(std::shared_ptr<const simulation::Model> the_model,
                       simulation::DisassemblyPlan the_plan, std::uint64_t seed = 1)
      : plan(std::move(the_plan)),
        simulation(the_model, haptics::TickOptions{}),
        person({}, seed, simulation::StartOfHand(*the_model)),
        run(&simulation, &plan, &person, &watch) {
    simulation::PutAllInPlace(&simulation);
    (void)simulation::RunLockstep(run.MakeExecution(&person, 300));
  }

  simulation::DisassemblyPlan plan;
  simulation::Simulation simulation;
  SimulatedPerson person;
  testing::Watch watch;
  simulation::DisassemblyRun run;
};

TEST(DisassemblyPlanTest, X16PartsThatAreNotInTheirPlaceAreNotInTheWay) {
  const auto model = CompiledModel(sequence::testing::CoinUnderLid());
  simulation::DisassemblyOptions options;
  options.target = Find(*model, "coin");
  options.is_in_place.assign(model->bodies.size(), true);
  options.is_in_place[Find(*model, "lid").index()] = false;
  EXPECT_EQ(OrderOf(*model, simulation::PlanDisassembly(*model, options)), Names{"coin"});
  options.target = {};  // all that is there
  EXPECT_EQ(OrderOf(*model, simulation::PlanDisassembly(*model, options)), Names{"coin"});
}

TEST(DisassemblyRunTest, X16PersonDrawsThePegOutAndPutsItOnTheTable) {
  const auto& model = simulation::testing::PegInBlockModel();
  const simulation::DisassemblyPlan plan = simulation::PlanDisassembly(*model, {});
  const Disassembly first(model, plan);
  EXPECT_TRUE(first.run.is_done());
  ASSERT_EQ(first.run.results().size(), 1u);
  const simulation::PartResult& peg = first.run.results()[0];
  EXPECT_EQ(peg.reason, "");
  EXPECT_FALSE(peg.is_seated);
  EXPECT_EQ(first.simulation.physics().placement(peg.occurrence), simulation::Placement::kLoose);
  const Vec3 p = first.simulation.physics().pose(peg.occurrence).p();
  const Vec3 p_start = model->bodies[peg.occurrence.index()].X_WB_start.p();
  EXPECT_LT((p - p_start).head<2>().norm(), 20e-3);
  EXPECT_LT(first.watch.deepest, 0.1e-3);
  const Disassembly again(model, plan);
  EXPECT_EQ(again.watch.Hex(), first.watch.Hex());
  const Disassembly other(model, plan, 2);
  EXPECT_NE(other.watch.Hex(), first.watch.Hex());
}

TEST(DisassemblyRunTest, X16EachPartComesOutAfterThoseInItsWay) {
  for (const auto& model : {CompiledModel(sequence::testing::CoinUnderLid()),
                            CompiledModel(sequence::testing::CappedCollarUnderClamp())}) {
    const Disassembly whole(model, simulation::PlanDisassembly(*model, {}));
    EXPECT_EQ(whole.run.results().size(), model->bodies.size() - 1);
    for (const simulation::PartResult& part : whole.run.results()) {
      EXPECT_EQ(part.reason, "") << model->product->occurrences[part.occurrence.index()].path;
    }
    EXPECT_LT(whole.watch.deepest, 0.1e-3);
  }
}

}  // namespace
}  // namespace hvas::person
