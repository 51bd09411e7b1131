#include "simulation/guided_hand.h"

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "simulation/assembly_run.h"
#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using testing::CompileFast;
using testing::PegInBlockModel;

const OccurrenceId kGuidedPeg(1);
constexpr double kLimit = 120;  // [s] of session time

haptics::TickOptions GuidedTick(double rate_hz) {
  haptics::TickOptions tick;
  tick.device.max_force = 1.2 * kMostHandForce;
  tick.device.max_torque = 20;
  tick.coupling = {4000, 90, 60, 3};
  tick.dt = 1 / rate_hz;
  return tick;
}

/** A run by a guided hand, and how far the part was beside its straight way near its place. */
struct GuidedRun {
  explicit GuidedRun(std::shared_ptr<const Model> given, double rate_hz = 1000)
      : model(std::move(given)),
        simulation(model, GuidedTick(rate_hz)),
        hand(StartOfHand(*model)),
        run(&simulation, &hand, nullptr) {
    Execution execution = run.MakeExecution(&hand, kLimit);
    report = RunLockstep(execution);
  }

  std::shared_ptr<const Model> model;
  Simulation simulation;
  GuidedHand hand;
  AssemblyRun run;
  ExecutionReport report;
};

TEST(GuidedHandTest, BringsThePegHomeAtEveryRate) {  // N10
  for (const double rate_hz : {1000.0, 2000.0, 4000.0}) {
    const GuidedRun guided(PegInBlockModel(), rate_hz);
    ASSERT_TRUE(guided.run.is_done()) << rate_hz;
    for (const PartResult& part : guided.run.results()) {
      EXPECT_TRUE(part.is_seated) << rate_hz << " Hz: " << part.reason;
      EXPECT_FALSE(part.is_assumed);
      EXPECT_LT(part.deepest, 20e-6);
    }
    EXPECT_FALSE(guided.hand.gave_up());
  }
}

TEST(GuidedHandTest, EqualRunsAreEqualInEveryTick) {
  const GuidedRun first(PegInBlockModel());
  const GuidedRun second(PegInBlockModel());
  EXPECT_EQ(first.report.ticks, second.report.ticks);
  EXPECT_EQ(first.run.results()[1].path, second.run.results()[1].path);
  EXPECT_EQ(first.run.results()[1].peak_felt, second.run.results()[1].peak_felt);
}

TEST(GuidedHandTest, PushesAPressFitHomeAndSaysThatItNeedsAPress) {
  const GuidedRun guided(testing::PressedPegModel());
  const PartResult& peg = guided.run.results()[1];
  EXPECT_TRUE(peg.is_seated) << peg.reason;
  EXPECT_EQ(peg.needs_press(), peg.fit_true > kMostHandForce);
  EXPECT_EQ(peg.note.find("needs a press") != std::string::npos, peg.needs_press());
}

/** The peg's step goes in from a side on which the block is closed. */
std::shared_ptr<const Model> PegFromTheClosedSide() {
  auto model = std::make_shared<Model>(*PegInBlockModel());
  for (sequence::SequenceStep& step : model->sequence.steps) {
    if (step.occurrence == kGuidedPeg) {
      step.extraction_W = -step.extraction_W;
    }
  }
  return model;
}

TEST(GuidedHandTest, IsHeldUpByAWallAndSaysWhereAndByWhat) {
  const GuidedRun guided(PegFromTheClosedSide());
  ASSERT_TRUE(guided.run.is_done());
  EXPECT_TRUE(guided.hand.gave_up());
  const PartResult& peg = guided.run.results()[1];
  EXPECT_FALSE(peg.is_seated);
  EXPECT_TRUE(peg.is_assumed);
  EXPECT_NE(peg.reason.find("path-not-followed"), std::string::npos) << peg.reason;
  EXPECT_NE(peg.reason.find("block"), std::string::npos) << peg.reason;
  EXPECT_LE(peg.peak_felt, 1.2 * kMostHandForce);
}

/** No way was found for the peg. */
std::shared_ptr<const Model> PegWithoutAWay() {
  auto model = std::make_shared<Model>(*PegInBlockModel());
  for (sequence::SequenceStep& step : model->sequence.steps) {
    if (step.occurrence == kGuidedPeg) {
      step.kind = sequence::SequenceStep::Kind::kAssume;
    }
  }
  model->sequence.gaps.push_back({kGuidedPeg, "no way was found"});
  return model;
}

TEST(GuidedHandTest, APartWithoutAWayIsAssumedWithItsReason) {
  const GuidedRun guided(PegWithoutAWay());
  ASSERT_TRUE(guided.run.is_done());
  const PartResult& peg = guided.run.results()[1];
  EXPECT_FALSE(peg.is_seated);
  EXPECT_TRUE(peg.is_assumed);
  EXPECT_EQ(peg.reason, "no way was found");
  EXPECT_EQ(guided.simulation.physics().placement(kGuidedPeg), Placement::kPlaced);
}

}  // namespace
}  // namespace hvas::simulation
