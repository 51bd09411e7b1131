// Parts that are put together on the table are one body (X1).

#include "simulation/table_subassembly.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "person/test/session.h"
#include "person/test/waypoints.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using simulation::testing::PegInCarrierInCupModel;
using testing::CarryOver;
using testing::WaypointHand;

constexpr std::size_t kCup = 0;
constexpr std::size_t kCarrier = 1;
constexpr std::size_t kCarriedPeg = 2;
constexpr double kSamePlace = 1e-9;  // [m]

class X1TableSubassemblyTest : public ::testing::Test {
 protected:
  X1TableSubassemblyTest()
      : model_(*PegInCarrierInCupModel()),
        simulation_(PegInCarrierInCupModel(), haptics::TickOptions()),
        run_(&simulation_, simulation::TaskOperators{}, &watch_) {
    simulation_.physics().AllowJoining(0);
    simulation_.physics().AllowTakingOut(0);
    run_.Advance();
    EXPECT_EQ(sequence::FindBase(model_.sequence), OccurrenceId(kCup));
  }

  void Run(std::vector<testing::Waypoint> way) {
    WaypointHand hand(std::move(way));
    simulation::Execution execution = run_.MakeExecution(&hand, 60);
    execution.is_done = [&hand] { return hand.is_done(); };
    (void)simulation::RunLockstep(execution);
  }

  [[nodiscard]] simulation::PhysicsSide& physics() { return simulation_.physics(); }

  [[nodiscard]] Vec3 CentreOf(std::size_t part) {
    return physics().pose(OccurrenceId(part)) * model_.bodies[part].mass.p_BoBcm_B;
  }

  [[nodiscard]] simulation::Placement PlacementOf(std::size_t part) {
    return physics().placement(OccurrenceId(part));
  }

  [[nodiscard]] OccurrenceId LeaderOf(std::size_t part) { return physics().parts()[part].leader; }

  /** How far the peg is from where it is drawn in the carrier [m]. */
  [[nodiscard]] double CalcPegOffset() {
    const Pose X_CP = physics().pose(OccurrenceId(kCarrier)).Inverse() *
                      physics().pose(OccurrenceId(kCarriedPeg));
    const Pose X_drawn =
        model_.bodies[kCarrier].X_WB_goal.Inverse() * model_.bodies[kCarriedPeg].X_WB_goal;
    return (X_CP.p() - X_drawn.p()).norm() +
           kReach * spatial::RotationBetween(X_CP.q(), X_drawn.q()).norm();
  }

  /** Where the peg's centre of mass belongs in the carrier as that one stands. */
  [[nodiscard]] Vec3 CalcPegGoal() {
    return physics().pose(OccurrenceId(kCarrier)) * model_.bodies[kCarrier].X_WB_goal.Inverse() *
           model_.bodies[kCarriedPeg].X_WB_goal * model_.bodies[kCarriedPeg].mass.p_BoBcm_B;
  }

  void PutPegIntoCarrier() {
    const Vec3 p_goal = CalcPegGoal();
    Run(CarryOver(CentreOf(kCarriedPeg), p_goal, p_goal.z() + 60e-3));
  }

  [[nodiscard]] Vec3 CentreOfBoth() {
    const double m_c = model_.bodies[kCarrier].mass.mass;
    const double m_p = model_.bodies[kCarriedPeg].mass.mass;
    return (m_c * CentreOf(kCarrier) + m_p * CentreOf(kCarriedPeg)) / (m_c + m_p);
  }

  void PutBothIntoCup() {
    const Vec3 p_from = CentreOfBoth();
    const Vec3 p_goal = model_.bodies[kCarrier].X_WB_goal *
                        (physics().pose(OccurrenceId(kCarrier)).Inverse() * p_from);
    Run(CarryOver(p_from, p_goal, p_goal.z() + 60e-3));
  }

  static constexpr double kReach = 30e-3;  // [m] of the parts, to weigh an angle

  const simulation::Model& model_;
  testing::Watch watch_;
  simulation::Simulation simulation_;
  simulation::AssemblyRun run_;
};

TEST_F(X1TableSubassemblyTest, X1GroupHasMassCentreAndInertiaOfItsParts) {
  simulation::GroupStore store(model_);
  const auto group = store.Get({OccurrenceId(kCarrier), OccurrenceId(kCarriedPeg)});
  EXPECT_EQ(store.Get({OccurrenceId(kCarrier), OccurrenceId(kCarriedPeg)}), group);
  const dynamics::MassProperties& carrier = model_.bodies[kCarrier].mass;
  const dynamics::MassProperties& peg = model_.bodies[kCarriedPeg].mass;
  EXPECT_NEAR(group->mass, carrier.mass + peg.mass, 1e-15);
  const Vec3 p_peg = peg.p_BoBcm_B + Vec3(0, 0, 2e-3);  // in the carrier
  const Vec3 centre = (carrier.mass * carrier.p_BoBcm_B + peg.mass * p_peg) / group->mass;
  EXPECT_LT((group->p_BoBcm_B - centre).norm(), 1e-12);
  // Each about the common centre, by Steiner's theorem.
  Mat3 inertia = Mat3::Zero();
  const auto add = [&](const dynamics::MassProperties& mass, const Vec3& p) {
    const Vec3 d = p - centre;
    inertia += mass.I_BBcm_B + mass.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
  };
  add(carrier, carrier.p_BoBcm_B);
  add(peg, p_peg);
  EXPECT_LT((group->I_BBcm_B - inertia).norm(), 1e-9 * inertia.norm());
}

TEST_F(X1TableSubassemblyTest, X1PartsPutTogetherOnTheTableAreOneBody) {
  PutPegIntoCarrier();
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kLoose);
  EXPECT_EQ(PlacementOf(kCarrier), simulation::Placement::kLoose);
  EXPECT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  EXPECT_EQ(LeaderOf(kCarrier), OccurrenceId(kCarrier));
  EXPECT_FALSE(LeaderOf(kCup).is_valid());
  EXPECT_LT(CalcPegOffset(), kSamePlace);
  const auto dropped = std::find_if(watch_.events.rbegin(), watch_.events.rend(), [](auto& event) {
    return event.kind == simulation::SimulationEvent::Kind::kDropped;
  });
  ASSERT_NE(dropped, watch_.events.rend());
  EXPECT_EQ(dropped->onto, OccurrenceId(kCarrier));
  EXPECT_FALSE(dropped->was_seated) << "it is not in the product";
}

TEST_F(X1TableSubassemblyTest, X1WithoutLeaveToJoinAPegOnTheCarrierIsByItself) {
  simulation::Simulation other(PegInCarrierInCupModel(), haptics::TickOptions());
  simulation::AssemblyRun run(&other, simulation::TaskOperators{}, nullptr);
  run.Advance();
  const Vec3 p_goal = CalcPegGoal();
  WaypointHand hand(CarryOver(CentreOf(kCarriedPeg), p_goal, p_goal.z() + 60e-3));
  simulation::Execution execution = run.MakeExecution(&hand, 60);
  execution.is_done = [&hand] { return hand.is_done(); };
  (void)simulation::RunLockstep(execution);
  EXPECT_FALSE(other.physics().parts()[kCarriedPeg].leader.is_valid());
}

TEST_F(X1TableSubassemblyTest, X1SubassemblyIsCarriedAndLetGoItStaysTogether) {
  PutPegIntoCarrier();
  ASSERT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  const Vec3 p_from = CentreOfBoth();
  const Vec3 p_to = p_from + Vec3(-0.12, -0.02, 40e-3);  // it falls from there
  Run(CarryOver(p_from, p_to, p_from.z() + 60e-3));
  const auto taken = std::find_if(watch_.events.rbegin(), watch_.events.rend(), [](auto& event) {
    return event.kind == simulation::SimulationEvent::Kind::kTaken;
  });
  EXPECT_EQ(taken->occurrence, OccurrenceId(kCarrier));
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kLoose);
  EXPECT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  EXPECT_LT(CalcPegOffset(), kSamePlace);
  EXPECT_LT((CentreOfBoth() - p_to).head<2>().norm(), 20e-3);
  EXPECT_LT(CentreOfBoth().z(), p_to.z() - 20e-3) << "it has fallen";
  EXPECT_GT(CentreOf(kCarriedPeg).z(), model_.table_z) << "but not through the table";
  EXPECT_TRUE(watch_.is_finite);
}

TEST_F(X1TableSubassemblyTest, X1SubassemblyIsInsertedAndDrawnOutAsOne) {
  PutPegIntoCarrier();
  ASSERT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  PutBothIntoCup();
  ASSERT_EQ(PlacementOf(kCarrier), simulation::Placement::kPlaced);
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kPlaced);
  for (const std::size_t part : {kCarrier, kCarriedPeg}) {
    const Vec3 p = physics().pose(OccurrenceId(part)).p();
    EXPECT_LT((p - model_.bodies[part].X_WB_goal.p()).norm(), 1e-6) << part;
  }
  EXPECT_EQ(run_.next_step(), model_.sequence.steps.size()) << "both steps are done";
  const Vec3 p_from = CentreOfBoth();
  Run(CarryOver(p_from, p_from + Vec3(0.15, 0, 0.05), p_from.z() + 60e-3));
  EXPECT_EQ(PlacementOf(kCarrier), simulation::Placement::kLoose);
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kLoose);
  EXPECT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  EXPECT_LT(CalcPegOffset(), kSamePlace);
  EXPECT_LT(run_.next_step(), model_.sequence.steps.size()) << "both steps are to be done again";
}

TEST_F(X1TableSubassemblyTest, X1SimulatedPersonInsertsTheSubassemblyAsOne) {
  PutPegIntoCarrier();
  ASSERT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  SimulatedPerson person({}, 1, simulation::StartOfHand(model_));
  testing::Watch seen;
  simulation::AssemblyRun again(&simulation_, &person, &seen);
  again.Resume(run_.next_step());
  (void)simulation::RunLockstep(again.MakeExecution(&person, 120));
  EXPECT_TRUE(again.is_done());
  EXPECT_EQ(PlacementOf(kCarrier), simulation::Placement::kPlaced);
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kPlaced);
  EXPECT_LT(CalcPegOffset(), 1e-6);
  const auto takes = std::count_if(seen.events.begin(), seen.events.end(), [](auto& event) {
    return event.kind == simulation::SimulationEvent::Kind::kTaken;
  });
  EXPECT_EQ(takes, 1) << "both went in one hold";
  for (const simulation::PartResult& result : again.results()) {
    EXPECT_TRUE(result.is_seated) << result.reason;
    EXPECT_EQ(result.reason, "");
  }
}

TEST_F(X1TableSubassemblyTest, X1MemberTakenAloneLeavesItsSubassembly) {
  PutPegIntoCarrier();
  ASSERT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  const Pose X_carrier = physics().pose(OccurrenceId(kCarrier));
  physics().Prepare(simulation::MakeTableStep(model_, physics().parts(), OccurrenceId(kCarriedPeg),
                                              simulation::TakeExtent::kAlone));
  const Vec3 p_from = CentreOf(kCarriedPeg);
  Run(CarryOver(p_from, p_from + Vec3(-0.1, 0, 0.03), p_from.z() + 60e-3));
  EXPECT_FALSE(LeaderOf(kCarriedPeg).is_valid());
  EXPECT_FALSE(LeaderOf(kCarrier).is_valid());
  EXPECT_EQ(PlacementOf(kCarriedPeg), simulation::Placement::kLoose);
  EXPECT_GT(CalcPegOffset(), 50e-3);
  EXPECT_LT((physics().pose(OccurrenceId(kCarrier)).p() - X_carrier.p()).norm(), 1e-3);
}

TEST_F(X1TableSubassemblyTest, X1SubassemblyIsThereAfterRestoringTheParts) {
  PutPegIntoCarrier();
  ASSERT_EQ(LeaderOf(kCarriedPeg), OccurrenceId(kCarrier));
  const std::vector<simulation::PartState> parts = physics().parts();
  simulation::Simulation again(PegInCarrierInCupModel(), haptics::TickOptions());
  again.Restore(parts);
  simulation::AssemblyRun run(&again, simulation::TaskOperators{}, nullptr);
  run.Resume(1);
  const Vec3 p_from = CentreOfBoth();
  WaypointHand hand(CarryOver(p_from, p_from + Vec3(-0.12, 0, 0.02), p_from.z() + 60e-3));
  simulation::Execution execution = run.MakeExecution(&hand, 60);
  execution.is_done = [&hand] { return hand.is_done(); };
  (void)simulation::RunLockstep(execution);
  const Vec3 moved =
      again.physics().pose(OccurrenceId(kCarriedPeg)).p() - parts[kCarriedPeg].X_WB.p();
  EXPECT_GT(moved.norm(), 50e-3) << "the peg went with the carrier";
  EXPECT_EQ(again.physics().parts()[kCarriedPeg].leader, OccurrenceId(kCarrier));
}

}  // namespace
}  // namespace hvas::person
