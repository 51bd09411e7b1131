// A part that is in its place is taken out again by hand, by the way it came (X16).

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Pose;

constexpr std::size_t kTakenPeg = 1;

/** A hand that closes at a place, goes along a straight line, and opens at its end. */
class StraightHand final : public simulation::Operator {
 public:
  StraightHand(const Vec3& p_from, const Vec3& p_to) : p_from_(p_from), p_to_(p_to) {}

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override {
    t_ = t_ < 0 ? 0 : t_ + input.dt;
    device::DeviceState state;
    state.t_ns = input.t_ns;
    state.is_valid = true;
    const double share = std::clamp((t_ - kRest) / kMove, 0.0, 1.0);
    state.X_DH = Pose(Vec3(p_from_ + share * (p_to_ - p_from_)));
    state.V_DH.v = share > 0 && share < 1 ? Vec3((p_to_ - p_from_) / kMove) : Vec3::Zero();
    state.is_gripping = t_ > 0.5 * kRest && t_ < kRest + kMove + kRest;
    return state;
  }

  [[nodiscard]] bool is_done() const { return t_ > kRest + kMove + 2 * kRest; }

 private:
  static constexpr double kRest = 0.4;  // [s]
  static constexpr double kMove = 2.0;  // [s]
  Vec3 p_from_;
  Vec3 p_to_;
  double t_{-1};
};

class TakeOutTest : public ::testing::Test {
 protected:
  TakeOutTest() : session_(simulation::testing::PegInBlockModel()) {
    (void)simulation::RunLockstep(session_.MakeExecution(60));
    EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
              simulation::Placement::kPlaced);
  }

  /** Goes on where the run is, with a hand that takes the peg out along `way`. */
  void Pull(const Vec3& way, simulation::AssemblyRun* run) {
    sequence::SequenceStep step = StepOfPeg();
    step.kind = sequence::SequenceStep::Kind::kRemove;
    session_.simulation.physics().Prepare(step);
    PullWhatIsThere(way, run);
  }

  /** With a hand that closes where the peg is. */
  void PullWhatIsThere(const Vec3& way, simulation::AssemblyRun* run) {
    const simulation::Simulation& simulation = session_.simulation;
    const Vec3 p_WG = simulation.physics().pose(OccurrenceId(kTakenPeg)) *
                      simulation.model().bodies[kTakenPeg].mass.p_BoBcm_B;
    StraightHand hand(p_WG, p_WG + way);
    simulation::Execution execution = run->MakeExecution(&hand, 10);
    execution.is_done = [&hand] { return hand.is_done(); };
    (void)simulation::RunLockstep(execution);
  }

  [[nodiscard]] const sequence::SequenceStep& StepOfPeg() const {
    return session_.simulation.model().sequence.steps.back();
  }

  [[nodiscard]] Pose pose() const {
    return session_.simulation.physics().pose(OccurrenceId(kTakenPeg));
  }

  testing::Session session_;
  testing::Watch watch_;
};

TEST_F(TakeOutTest, PegComesOutOfItsBoreAndItsStepIsToBeDoneAgain) {
  simulation::AssemblyRun hands(&session_.simulation, simulation::TaskOperators{}, &watch_);
  hands.Advance();
  const Pose before = pose();
  Pull(Vec3(0, 0, 60e-3), &hands);
  EXPECT_GT(pose().p().z(), before.p().z() + 15e-3);  // it fell on the block
  EXPECT_LT(watch_.deepest, 0.2e-3);
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kLoose);
  EXPECT_EQ(hands.next_step(), session_.simulation.model().sequence.steps.size() - 1);
  const auto seen = [this](haptics::HoldState state) {
    return std::any_of(
        watch_.events.begin(), watch_.events.end(),
        [state](const simulation::SimulationEvent& event) { return event.state == state; });
  };
  EXPECT_TRUE(seen(haptics::HoldState::kMating));
  EXPECT_FALSE(seen(haptics::HoldState::kSeated));  // it is not drawn back into its place
}

TEST_F(TakeOutTest, HandOfADeviceTakesOutWhatItClosesOn) {
  simulation::AssemblyRun hands(&session_.simulation, simulation::TaskOperators{}, &watch_);
  hands.Advance();
  const Pose before = pose();
  PullWhatIsThere(Vec3(0, 0, 60e-3), &hands);  // nobody has said that it may
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kPlaced);
  EXPECT_EQ((pose().p() - before.p()).norm(), 0);
  session_.simulation.physics().AllowTakingOut(0);
  PullWhatIsThere(Vec3(0, 0, 60e-3), &hands);
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kLoose);
  EXPECT_GT(pose().p().z(), before.p().z() + 15e-3);
}

TEST_F(TakeOutTest, PegThatIsHeldAndLetGoIsWhereItWas) {
  simulation::AssemblyRun hands(&session_.simulation, simulation::TaskOperators{}, &watch_);
  hands.Advance();
  const Pose before = pose();
  Pull(Vec3(0, 0, 1e-3), &hands);
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kPlaced);
  EXPECT_EQ((pose().p() - before.p()).norm(), 0);
}

TEST_F(TakeOutTest, WallOfTheBoreHoldsThePegBackSideways) {
  simulation::AssemblyRun hands(&session_.simulation, simulation::TaskOperators{}, &watch_);
  hands.Advance();
  const Pose before = pose();
  Pull(Vec3(40e-3, 0, 0), &hands);
  EXPECT_LT((pose().p() - before.p()).norm(), 1e-3);
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kPlaced);
}

TEST_F(TakeOutTest, PersonPutsItInAgain) {
  simulation::AssemblyRun hands(&session_.simulation, simulation::TaskOperators{}, &watch_);
  hands.Advance();
  Pull(Vec3(0, 30e-3, 60e-3), &hands);
  ASSERT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kLoose);
  simulation::AssemblyRun again(&session_.simulation, &session_.person, nullptr);
  again.Resume(hands.next_step());
  (void)simulation::RunLockstep(again.MakeExecution(&session_.person, 120));
  EXPECT_EQ(session_.simulation.physics().placement(OccurrenceId(kTakenPeg)),
            simulation::Placement::kPlaced);
}

}  // namespace
}  // namespace hvas::person
