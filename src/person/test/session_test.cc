#include "person/test/session.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using device::DeviceState;
using product::OccurrenceId;
using simulation::testing::PegInBlockModel;
using spatial::Pose;
using testing::Session;

constexpr double kSessionTime = 120;  // [s]
const OccurrenceId kPeg(1);

TEST(SessionTest, PegGoesIntoItsBlockExactly) {  // N10, X9
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Session session(PegInBlockModel(), seed);
    const simulation::ExecutionReport report =
        simulation::RunLockstep(session.MakeExecution(kSessionTime));
    ASSERT_TRUE(session.run.is_done());
    ASSERT_EQ(session.run.results().size(), 2u);
    for (const simulation::PartResult& part : session.run.results()) {
      EXPECT_TRUE(part.is_seated) << "seed " << seed << ": " << part.reason;
      EXPECT_LT(part.pose_error, 1e-6);
      EXPECT_LT(part.pose_error_angle, 1e-6);
    }
    const simulation::PartResult& peg = session.run.results()[1];
    EXPECT_EQ(peg.occurrence, kPeg);
    EXPECT_EQ(peg.mates, 2);  // bore and floor
    EXPECT_GT(peg.time, 1);
    EXPECT_GT(peg.path, (PegInBlockModel()->bodies[1].X_WB_start.p() -
                         PegInBlockModel()->bodies[1].X_WB_goal.p())
                            .norm());
    EXPECT_EQ(report.ticks, session.watch.ticks);
    EXPECT_EQ(report.session_ns, static_cast<std::int64_t>(report.ticks) * 1'000'000);
    EXPECT_TRUE(session.watch.is_finite);
  }
}

TEST(SessionTest, ForceNeverJumpsAndNothingSinksIn) {  // N6
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Session session(PegInBlockModel(), seed);
    (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
    EXPECT_LE(session.watch.largest_jump, 0.5)
        << "seed " << seed << " at " << session.watch.t_of_jump_ns << " ns";
    EXPECT_LE(session.watch.deepest, 50e-6) << "seed " << seed;
    EXPECT_LE(session.watch.largest_force, haptics::TickOptions().device.max_force + 1e-9);
  }
}

TEST(SessionTest, EqualSeedsGiveEqualBitsAndOthersDoNot) {
  std::vector<std::string> hashes;
  for (const std::uint64_t seed : {1, 1, 2}) {
    Session session(PegInBlockModel(), seed);
    (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
    hashes.push_back(session.watch.Hex());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0], hashes[2]);
}

TEST(SessionTest, StatesFollowOneAnotherUpToSeated) {
  Session session(PegInBlockModel());
  (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
  using Kind = simulation::SimulationEvent::Kind;
  const auto& events = session.watch.events;
  const auto of_kind = [&events](Kind kind) {
    return std::count_if(
        events.begin(), events.end(),
        [kind](const simulation::SimulationEvent& event) { return event.kind == kind; });
  };
  EXPECT_EQ(of_kind(Kind::kTaken), 1);
  EXPECT_EQ(of_kind(Kind::kDropped), 1);
  std::vector<haptics::HoldState> states;
  for (const simulation::SimulationEvent& event : events) {
    if (event.kind == Kind::kState) {
      states.push_back(event.state);
    }
  }
  // First free in the hand, at the end seated and then out of the hand; mating came before seated.
  ASSERT_GE(states.size(), 4u);
  EXPECT_EQ(states.front(), haptics::HoldState::kFree);
  EXPECT_EQ(states.back(), haptics::HoldState::kEmpty);
  EXPECT_EQ(*(states.end() - 2), haptics::HoldState::kSeated);
  EXPECT_NE(std::find(states.begin(), states.end(), haptics::HoldState::kMating), states.end());
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(),
                             [](const simulation::SimulationEvent& a,
                                const simulation::SimulationEvent& b) { return a.t_ns < b.t_ns; }));
}

TEST(SessionTest, LimitStopsARunInTheMiddle) {
  Session session(PegInBlockModel());
  const simulation::ExecutionReport report = simulation::RunLockstep(session.MakeExecution(1.0));
  EXPECT_FALSE(session.run.is_done());
  EXPECT_EQ(report.session_ns, 1'000'000'000);
  EXPECT_EQ(report.ticks, 1000u);
}

TEST(SessionTest, X14ConditionsOfTheExperimentRunToTheirEnd) {
  for (const auto condition : {haptics::Condition::kConstraint, haptics::Condition::kCollision}) {
    haptics::TickOptions options;
    options.condition = condition;
    Session session(PegInBlockModel(), 1, options);
    (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
    ASSERT_TRUE(session.run.is_done());
    const simulation::PartResult& peg = session.run.results()[1];
    EXPECT_TRUE(peg.is_seated || !peg.reason.empty());
    EXPECT_TRUE(session.watch.is_finite);
    EXPECT_LE(session.watch.largest_jump, 0.5);
    if (condition == haptics::Condition::kConstraint) {
      EXPECT_TRUE(peg.is_seated) << peg.reason;
      EXPECT_LT(peg.pose_error, 1e-6);
    } else {
      // No mate is captured.
      for (const simulation::SimulationEvent& event : session.watch.events) {
        EXPECT_NE(event.state, haptics::HoldState::kCaptured);
        EXPECT_NE(event.state, haptics::HoldState::kMating);
      }
    }
  }
}

TEST(SessionTest, PartThatCannotGoInIsAssumedInItsPlaceWithAReason) {  // N10
  // No mate guides this peg, and it is 1 mm too thick: contact with the block, which stands in its
  // fixture, keeps it out.
  product::Product tight = sequence::testing::PegInBlock();
  for (Vec3& v : tight.parts[1].mesh.vertices) {
    v.head<2>() *= 1.1;
  }
  tight.parts[1].faces[1].surface.radius *= 1.1;
  tight.mates.clear();
  Diagnostics diagnostics;
  const auto compiled = simulation::Compile(std::make_shared<product::Product>(tight),
                                            simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(compiled.has_value());
  auto model = std::make_shared<simulation::Model>(**compiled);
  model->sequence.overlaps.clear();  // the drawing's overlap would leave contact out
  PersonOptions habits;
  habits.patience_s = 5;
  Session session(model, 1, {}, habits);
  (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
  ASSERT_TRUE(session.run.is_done());
  const simulation::PartResult& peg = session.run.results()[1];
  EXPECT_FALSE(peg.is_seated);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "rig/block", peg.reason);
  EXPECT_LE(session.watch.largest_jump, 0.5);
  EXPECT_LE(session.watch.deepest, 50e-6);
  EXPECT_TRUE(peg.is_assumed);
  EXPECT_EQ(session.simulation.physics().placement(kPeg), simulation::Placement::kPlaced);
}

TEST(SessionTest, CaptivePartIsAResultWithItsReason) {
  Diagnostics diagnostics;
  const auto model =
      *simulation::Compile(std::make_shared<product::Product>(sequence::testing::CaptiveRing()),
                           simulation::testing::FastOptions(), &diagnostics);
  Session session(model);
  (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
  ASSERT_EQ(session.run.results().size(), 2u);
  EXPECT_TRUE(session.run.results()[0].is_seated);
  EXPECT_FALSE(session.run.results()[1].is_seated);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "captive/spool", session.run.results()[1].reason);
}

/** A hand that goes from place to place at constant speed. */
class ScriptedHand {
 public:
  explicit ScriptedHand(simulation::Simulation* simulation) : simulation_(simulation) {}

  void Run(double time, const Vec3& v = Vec3::Zero(), bool is_valid = true) {
    for (int i = 0, n = static_cast<int>(std::lround(1e3 * time)); i < n; ++i) {
      state.t_ns += 1'000'000;
      state.V_DH.v = v;
      state.X_DH = Pose(state.X_DH.q(), state.X_DH.p() + 1e-3 * v);
      state.is_valid = is_valid;
      DeviceState sent = state;
      if (!is_valid) {  // what a broken link may hand over
        sent.X_DH = Pose(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
        sent.is_gripping = false;
      }
      out = simulation_->haptics().Tick(0, sent);
      watch.OnTick(0, sent, out);
      if (state.t_ns % simulation::Simulation::kPhysicsStepNs == 0) {
        simulation_->physics().Step(&watch);
      }
    }
  }

  DeviceState state;
  haptics::TickOutput out;
  testing::Watch watch;

 private:
  simulation::Simulation* simulation_;
};

/** With the peg in the hand, lifted by 10 cm. */
void TakePegUp(simulation::Simulation* simulation, ScriptedHand* hand) {
  simulation->physics().PlaceInFixture(OccurrenceId(0));
  const simulation::Body& body = PegInBlockModel()->bodies[kPeg.index()];
  hand->state.X_DH = Pose(simulation->physics().pose(kPeg) * body.mass.p_BoBcm_B);
  hand->Run(0.1);
  ASSERT_EQ(simulation->physics().placement(kPeg), simulation::Placement::kLoose);
  hand->state.is_gripping = true;
  hand->Run(0.5);
  ASSERT_EQ(simulation->physics().placement(kPeg), simulation::Placement::kHeld);
  hand->Run(1.0, Vec3(0, 0, 0.1));
  hand->Run(0.3);
  ASSERT_NEAR(hand->out.X_WD.p().z(), body.X_WB_start.p().z() + 0.1, 5e-3);
}

/** Height of the lowest corner of the peg over the table [m]. */
double HeightOverTable(const simulation::Simulation& simulation) {
  double lowest = 1;
  for (const Vec3& p_B : simulation.model().product->part_of(kPeg).mesh.vertices) {
    lowest = std::min(lowest, (simulation.physics().pose(kPeg) * p_B).z());
  }
  return lowest - simulation.model().table_z;
}

TEST(SimulationTest, DroppedPartFallsToTheTableAndComesToRest) {
  simulation::Simulation simulation(PegInBlockModel(), haptics::TickOptions());
  ScriptedHand hand(&simulation);
  TakePegUp(&simulation, &hand);
  hand.state.is_gripping = false;
  hand.Run(0.05);
  ASSERT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kLoose);
  const double start = HeightOverTable(simulation);
  EXPECT_GT(start, 0.07);
  hand.Run(0.05);
  // Free fall within what the steps of 10 ms allow: g t^2 / 2 of the 50 ms plus those before.
  EXPECT_LT(HeightOverTable(simulation), start - 0.5 * 9.81 * 0.05 * 0.05 + 1e-3);
  EXPECT_GT(HeightOverTable(simulation), 0);
  hand.Run(3.0);
  EXPECT_NEAR(HeightOverTable(simulation), 0, 0.5e-3);
  const Pose X_WB = simulation.physics().pose(kPeg);
  hand.Run(1.0);
  EXPECT_LT((simulation.physics().pose(kPeg).p() - X_WB.p()).norm(), 10e-6);
  EXPECT_LT(spatial::RotationBetween(simulation.physics().pose(kPeg).q(), X_WB.q()).norm(), 1e-3);
  // And it can be taken up again from where it fell.
  hand.state.X_DH =
      Pose(simulation.physics().pose(kPeg) * PegInBlockModel()->bodies[1].mass.p_BoBcm_B);
  hand.Run(0.1);
  hand.state.is_gripping = true;
  hand.Run(0.2);
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kHeld);
}

TEST(SimulationTest, HandThatClosesOnNothingTakesNothing) {
  simulation::Simulation simulation(PegInBlockModel(), haptics::TickOptions());
  ScriptedHand hand(&simulation);
  const Vec3 p_WCm = simulation.physics().pose(kPeg) * PegInBlockModel()->bodies[1].mass.p_BoBcm_B;
  hand.state.X_DH = Pose(p_WCm + Vec3(0, 0, 60e-3));
  hand.state.is_gripping = true;
  hand.Run(0.2);
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kLoose);
  // A closed hand that passes the part does not take it along either.
  hand.Run(0.6, Vec3(0, 0, -0.1));
  hand.Run(0.2);
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kLoose);
  hand.state.is_gripping = false;
  hand.Run(0.05);
  hand.state.is_gripping = true;
  hand.Run(0.05);
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kHeld);
}

TEST(SimulationTest, LostDeviceFadesToZeroAndKeepsThePart) {  // N6
  simulation::Simulation simulation(PegInBlockModel(), haptics::TickOptions());
  ScriptedHand hand(&simulation);
  TakePegUp(&simulation, &hand);
  // A pull to the side, so that there is a force to lose.
  hand.Run(0.2, Vec3(0.05, 0, 0));
  hand.Run(0.2, Vec3::Zero(), false);
  EXPECT_TRUE(hand.watch.is_finite);
  EXPECT_LT(hand.out.F_H_W.f.norm(), 1e-3);
  EXPECT_LT(hand.out.F_H_W.t.norm(), 1e-3);
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kHeld);
  // Back again, 5 cm away: no blow, and the part follows.
  hand.state.X_DH = Pose(hand.state.X_DH.p() + Vec3(0.05, 0, 0));
  hand.Run(1.0);
  EXPECT_TRUE(hand.watch.is_finite);
  EXPECT_LE(hand.watch.largest_jump, 0.5) << "at " << hand.watch.t_of_jump_ns << " ns";
  EXPECT_EQ(simulation.physics().placement(kPeg), simulation::Placement::kHeld);
  EXPECT_LT((hand.out.X_WD.p() - hand.out.X_WT.p()).norm(), 2e-3);
}

TEST(SimulationTest, FramesShowEveryPartWhereItIs) {
  simulation::Simulation simulation(PegInBlockModel(), haptics::TickOptions());
  const simulation::Frame& first = simulation.Publish();
  ASSERT_EQ(first.X_WB.size(), 2u);
  EXPECT_EQ(first.X_WB[1].p(), PegInBlockModel()->bodies[1].X_WB_start.p());
  ScriptedHand hand(&simulation);
  TakePegUp(&simulation, &hand);
  const simulation::Frame& frame = simulation.Publish();
  EXPECT_EQ(frame.t_ns, hand.state.t_ns);
  EXPECT_EQ(frame.X_WB[0].p(), PegInBlockModel()->bodies[0].X_WB_goal.p());
  EXPECT_EQ(frame.X_WB[1].p(), hand.out.X_WD.p());
}

TEST(SessionTest, X14WhoMissesWhereNothingStopsThePartLooksAndComesAgain) {  // constraint only
  haptics::TickOptions options;
  options.condition = haptics::Condition::kConstraint;
  options.guidance.capture.axis_distance = 3e-3;
  PersonOptions hasty;
  hasty.carry_speed *= 1.5;
  hasty.aim_error *= 4;
  constexpr std::uint64_t kMissesAtFirst = 5;
  Session session(simulation::testing::PegInBlockModel(), kMissesAtFirst, options, hasty);
  (void)simulation::RunLockstep(session.MakeExecution(kSessionTime));
  EXPECT_EQ(session.simulation.physics().placement(sequence::testing::OccurrenceId(1)),
            simulation::Placement::kPlaced);
  EXPECT_GT(session.person.searches(), 0);
}

}  // namespace
}  // namespace hvas::person
