// With a mate active, what the guided part meets besides its partner still stops it (N3). Both
// papers switch collision off once a mate is captured; what they would do is shown beside it.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using haptics::HoldState;
using testing::Session;

const product::OccurrenceId kTrappedPeg(1);
const product::OccurrenceId kClamp(2);
constexpr double kTrapTime = 90;  // [s]
// How far the peg is in its bore when the collar meets the clamp.
constexpr double kDepthAtClamp =
    sequence::testing::kBlockHeight -
    (sequence::testing::kClampHeight - sequence::testing::kCollarHeight);

/** A product with the clamp in its place before the peg. */
std::shared_ptr<const simulation::Model> ClampFirst(product::Product product) {
  Diagnostics diagnostics;
  simulation::CompileOptions options = simulation::testing::FastOptions();
  options.first_parts = {"clamp", "peg"};
  return *simulation::Compile(std::make_shared<product::Product>(std::move(product)), options,
                              &diagnostics);
}

const std::shared_ptr<const simulation::Model>& TrapModel() {
  static const std::shared_ptr<const simulation::Model> model =
      ClampFirst(sequence::testing::CollarUnderClamp());
  return model;
}

/** Stands between the run and its record: what a guided part did. */
class Guided final : public simulation::Sink {
 public:
  void OnTick(std::size_t, const device::DeviceState&,
              const haptics::TickOutput& out) noexcept override {
    const bool is_guided = out.state == HoldState::kCaptured || out.state == HoldState::kMating;
    if (out.occurrence != kTrappedPeg || !is_guided) {
      return;
    }
    insertion = std::max(insertion, out.insertion_depth);
    deepest = std::max(deepest, -out.deepest);
    // On the clamp with the mate aligned: its faces answer by their fit, all others by contact.
    if (out.state == HoldState::kMating && out.contact_body.index() == kClamp.index()) {
      ++ticks_on_clamp;
      force_on_clamp = std::max(force_on_clamp, out.F_H_W.f.z());
      lowest_on_clamp = std::min(lowest_on_clamp, out.X_WD.p().z());
    }
  }

  void OnEvent(const simulation::SimulationEvent&) override {}

  double insertion{0};
  double deepest{0};
  int ticks_on_clamp{0};
  double force_on_clamp{0};
  double lowest_on_clamp{1};
};

struct Trial {
  Guided guided;
  std::vector<simulation::PartResult> results;
};

void Try(haptics::Condition condition, std::uint64_t seed, Trial* trial,
         const std::shared_ptr<const simulation::Model>& model = TrapModel()) {
  haptics::TickOptions options;
  options.condition = condition;
  PersonOptions habits;
  habits.patience_s = 6;  // Long enough to press as hard as it will, and to search once.
  Session session(model, seed, options, habits);
  simulation::AssemblyRun run(&session.simulation, &session.person, &trial->guided);
  (void)simulation::RunLockstep(run.MakeExecution(&session.person, kTrapTime));
  EXPECT_TRUE(run.is_done());
  trial->results = run.results();
}

TEST(TrapTest, GoesTogetherWhenTheClampComesLast) {  // The trap is in the order, not in the parts.
  Diagnostics diagnostics;
  const auto model =
      simulation::Compile(std::make_shared<product::Product>(sequence::testing::CollarUnderClamp()),
                          simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value());
  EXPECT_EQ((*model)->sequence.steps.back().occurrence, kClamp);
  Session session(*model);
  (void)simulation::RunLockstep(session.MakeExecution(kTrapTime));
  for (const simulation::PartResult& part : session.run.results()) {
    EXPECT_TRUE(part.is_seated) << part.reason;
  }
}

TEST(TrapTest, GuidedPegStopsAtAThirdPartAndTheHandFeelsIt) {  // N3
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(seed);
    Trial trial;
    Try(haptics::Condition::kHybrid, seed, &trial);
    ASSERT_EQ(trial.results.size(), 3U);
    EXPECT_TRUE(trial.results[1].is_seated) << "the clamp: " << trial.results[1].reason;
    const simulation::PartResult& peg = trial.results[2];
    ASSERT_EQ(peg.occurrence, kTrappedPeg);
    EXPECT_FALSE(peg.is_seated);
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "trap/clamp stood in the way", peg.reason);
    // Guided, and in its bore to the depth at which the collar meets the clamp: to the compliance
    // of contact under the push of a hand (0.5 um/N), and to the tilt that the fit's play leaves.
    EXPECT_GT(trial.guided.ticks_on_clamp, 1000);
    EXPECT_NEAR(trial.guided.insertion, kDepthAtClamp, 20e-6);
    EXPECT_LT(trial.guided.deepest, 25e-6);
    EXPECT_EQ(peg.passage.depth, 0);
    EXPECT_GT(trial.guided.lowest_on_clamp,
              sequence::testing::kBlockHeight - kDepthAtClamp - 20e-6);
    EXPECT_GT(trial.guided.force_on_clamp, 4.0);  // [N]; what a hand tries first
  }
}

TEST(TrapTest, APartThatFailedIsAssumedForWhatGoesToIt) {
  Trial trial;
  Try(haptics::Condition::kHybrid, 1, &trial,
      ClampFirst(sequence::testing::CappedCollarUnderClamp()));
  ASSERT_EQ(trial.results.size(), 4U);
  EXPECT_FALSE(trial.results[2].is_seated);
  EXPECT_TRUE(trial.results[2].is_assumed);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "; tried 3 times", trial.results[2].reason);
  EXPECT_TRUE(trial.results[3].is_seated) << "the cap: " << trial.results[3].reason;
  EXPECT_TRUE(trial.results[0].has_touched);   // in the fixture
  EXPECT_FALSE(trial.results[1].has_touched);  // the clamp, 0.5 mm from the collar
  EXPECT_TRUE(trial.results[3].has_touched);   // the peg, where it is assumed
}

TEST(TrapTest, WithoutCollisionTheGuidedPegGoesThroughTheThirdPart) {  // as both papers have it
  Trial trial;
  Try(haptics::Condition::kConstraint, 1, &trial);
  ASSERT_EQ(trial.results.size(), 3U);
  EXPECT_TRUE(trial.results[2].is_seated) << trial.results[2].reason;
  EXPECT_EQ(trial.guided.ticks_on_clamp, 0);
  // What it went through is found without the ticks.
  EXPECT_EQ(trial.results[2].passage.through, kClamp);
  EXPECT_GT(trial.results[2].passage.depth, 0.5e-3);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "went through trap/clamp", trial.results[2].note);
  EXPECT_GT(trial.guided.insertion,
            sequence::testing::kBlockHeight - sequence::testing::kFloor - 0.5e-3);
}

}  // namespace
}  // namespace hvas::person
