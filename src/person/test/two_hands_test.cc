// Two hands in one scene: X3, X4, X7, N8.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "device/driver.h"
#include "device/emulation/emulator.h"
#include "device/profile.h"
#include "person/person_at_device.h"
#include "person/test/moved_hands.h"
#include "person/test/session.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using device::DeviceState;
using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using testing::Watch;

static_assert(
    noexcept(std::declval<simulation::HapticSide&>().Tick(1, std::declval<const DeviceState&>())));
static_assert(noexcept(std::declval<const haptics::HapticTick&>().Exchange(1)));

using testing::kHalf;
const OccurrenceId kFirst(0);
const OccurrenceId kSecond(1);
const OccurrenceId kThird(2);

/** Three blocks with nothing to do with one another. */
const std::shared_ptr<const simulation::Model>& Blocks() {
  static const std::shared_ptr<const simulation::Model> model = testing::MakeBlocks(3);
  return model;
}

/** Two hands that go from place to place at constant speed, turning nothing. */
class TwoHands : public testing::MovedHands {
 public:
  explicit TwoHands(std::shared_ptr<const simulation::Model> model)
      : testing::MovedHands(std::move(model), 2) {}

  void Run(double time, const Vec3& v_0 = Vec3::Zero(), const Vec3& v_1 = Vec3::Zero()) {
    testing::MovedHands::Run(time, {v_0, v_1});
  }

  /** With a block in each hand, face to face along x, 5 mm apart, 10 cm over where they lay. */
  void TakeBlocksUp() {
    Take(0, kFirst);
    Take(1, kSecond);
    ASSERT_EQ(simulation.physics().placement(kFirst), simulation::Placement::kHeld);
    ASSERT_EQ(simulation.physics().placement(kSecond), simulation::Placement::kHeld);
    const Vec3 up(0, 0, 0.1);
    Run(1.0, up, up);
    const Vec3 p_beside = states[0].X_DH.p() + Vec3(2 * kHalf + 5e-3, 0, 0);
    Run(1.0, Vec3::Zero(), p_beside - states[1].X_DH.p());
    Run(0.3);
  }
};

/** How far the two hands' forces along x are from being equal and opposite, of their size. */
double CalcMismatch(const TwoHands& hands) {
  const double f_0 = hands.out[0].F_felt_W.f.x();
  const double f_1 = hands.out[1].F_felt_W.f.x();
  return std::abs(f_0 + f_1) / std::max(std::abs(f_0), std::abs(f_1));
}

// X4: the haptic loop goes on while physics gets no time, and says more than there is room for.
TEST(TwoHandsTest, PhysicsThatStandsStillForHalfAMinuteMissesNoPart) {
  TwoHands hands(Blocks());
  hands.TakeBlocksUp();
  hands.events.events.clear();
  for (int i = 0; i < 30'000; ++i) {
    for (std::size_t hand = 0; hand < 2; ++hand) {
      DeviceState& state = hands.states[hand];
      state.t_ns += 1'000'000;
      state.V_DH.v = Vec3::Zero();
      state.is_gripping = i < 10'000;
      state.condition = i % 2 == 0 ? device::Condition::kLost : device::Condition::kReady;
      hands.out[hand] = hands.simulation.haptics().Tick(hand, state);
    }
  }
  hands.Run(0.1);
  const auto& events = hands.events.events;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    SCOPED_TRACE(hand);
    EXPECT_FALSE(hands.simulation.physics().is_holding(hand));
    const auto of_hand = [hand](simulation::SimulationEvent::Kind kind) {
      return [hand, kind](const simulation::SimulationEvent& e) {
        return e.hand == hand && e.kind == kind;
      };
    };
    EXPECT_EQ(std::count_if(events.begin(), events.end(),
                            of_hand(simulation::SimulationEvent::Kind::kDropped)),
              1);
    const auto told = std::find_if(events.rbegin(), events.rend(),
                                   of_hand(simulation::SimulationEvent::Kind::kDevice));
    ASSERT_NE(told, events.rend());
    EXPECT_EQ(told->condition, device::Condition::kReady) << "the last one is said again";
  }
  hands.Run(1.0);  // until what was let go of lies on the table
  hands.Take(0, kFirst);
  hands.Take(1, kSecond);
  EXPECT_EQ(hands.simulation.physics().placement(kFirst), simulation::Placement::kHeld);
  EXPECT_EQ(hands.simulation.physics().placement(kSecond), simulation::Placement::kHeld);
}

constexpr double kDeepestOfTwoHands = 0.15e-3;  // [m]; docs/limits.md.

// One hand's step counts on the other's part giving way, which it does a tick later: how deep the
// first touch is depends on the gap that the last tick before it has left.
TEST(TwoHandsTest, FirstTouchIsWithinTheLimitWhateverGapIsLeft) {
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE(::testing::Message() << "10 um times " << i);
    TwoHands hands(Blocks());
    hands.TakeBlocksUp();
    hands.Run(0.1, Vec3(1e-4 * i, 0, 0));
    hands.Run(0.1, Vec3(0.1, 0, 0));
    EXPECT_GT(hands.out[0].contact_count, 2);
    for (const Watch& watch : hands.watches) {
      EXPECT_LE(watch.deepest, kDeepestOfTwoHands);
    }
  }
}

TEST(TwoHandsTest, X7PartsPushAgainstEachOtherWithOneForce) {
  TwoHands hands(Blocks());
  hands.TakeBlocksUp();
  for (const haptics::TickOutput& out : hands.out) {
    EXPECT_EQ(out.contact_count, 0);
  }
  hands.Run(0.1, Vec3(0.1, 0, 0));  // 5 mm beyond the first touch
  hands.Run(0.5);
  // Half of that for either hand's coupling.
  const double expected = haptics::CouplingGains().k_lin * 2.5e-3;
  EXPECT_NEAR(hands.out[0].F_felt_W.f.x(), -expected, 0.02 * expected);
  EXPECT_LT(CalcMismatch(hands), 0.01);
  EXPECT_GT(hands.out[0].contact_count, 2);
  EXPECT_EQ(hands.out[0].contact_count, hands.out[1].contact_count);
  EXPECT_EQ(hands.out[0].contact_body.index(), kSecond.index());
  EXPECT_EQ(hands.out[1].contact_body.index(), kFirst.index());
  EXPECT_EQ(hands.out[0].f_C_W, -hands.out[1].f_C_W);
  // Also on the way together, whoever pushes, once the start is over.
  for (const double speed : {0.05, -0.05, 0.2}) {
    const Vec3 v(speed, 0, 0);
    hands.Run(0.5, v, v);
    EXPECT_NEAR(hands.out[0].F_felt_W.f.x(), -expected, 0.02 * expected) << speed;
    EXPECT_LT(CalcMismatch(hands), 0.03) << speed;
  }
  for (const Watch& watch : hands.watches) {
    EXPECT_LE(watch.deepest, kDeepestOfTwoHands);
    EXPECT_TRUE(watch.is_finite);
  }
  // Turned about at once, which no hand can, they still do not get into each other.
  hands.Run(0.5, Vec3(-0.2, 0, 0), Vec3(-0.2, 0, 0));
  EXPECT_LE(hands.watches[0].deepest, 2 * haptics::ContactOptions().stop_depth);
  EXPECT_LT(CalcMismatch(hands), 0.03);
}

TEST(TwoHandsTest, X7OneRunsIntoTheOtherWithoutGettingIntoIt) {
  for (const std::size_t fast : {0u, 1u}) {
    SCOPED_TRACE(fast);
    TwoHands hands(Blocks());
    hands.TakeBlocksUp();
    std::array v{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    v[fast].x() = fast == 0 ? 0.5 : -0.5;
    hands.Run(0.03, v[0], v[1]);
    hands.Run(0.5);
    EXPECT_LE(hands.watches[0].deepest, 2 * haptics::ContactOptions().stop_depth);
    EXPECT_LT(CalcMismatch(hands), 0.01);
    EXPECT_GT(std::abs(hands.out[0].F_felt_W.f.x()), 3);
  }
}

TEST(TwoHandsTest, X7OneHandPressesWhatTheOtherHasOnTheTable) {
  for (const std::size_t upper : {0u, 1u}) {
    SCOPED_TRACE(upper);
    const std::size_t lower = 1 - upper;
    TwoHands hands(Blocks());
    hands.Take(lower, kFirst);
    hands.Take(upper, kSecond);
    const auto move = [&](const Vec3& v, double time) {
      hands.Run(time, upper == 0 ? v : Vec3::Zero(), upper == 1 ? v : Vec3::Zero());
    };
    move(Vec3(0, 0, 0.1), 0.6);
    const Vec3 p_over = hands.states[lower].X_DH.p() + Vec3(0, 0, 0.06);
    move(p_over - hands.states[upper].X_DH.p(), 1.0);
    move(Vec3(0, 0, -0.066), 0.5);
    move(Vec3::Zero(),
         1.0);  // it rattles at first, by a few hundredths of a millimetre
    // The upper hand presses 3 mm deep, and the table bears it: for 0.3 s without a change.
    const double expected = haptics::CouplingGains().k_lin * 3e-3;
    for (int i = 0; i < 300; ++i) {
      move(Vec3::Zero(), 1e-3);
      ASSERT_NEAR(hands.out[upper].F_felt_W.f.z(), expected, 0.02 * expected);
      ASSERT_NEAR(hands.out[lower].F_felt_W.f.z(), 0, 0.02 * expected);
      ASSERT_GE(hands.out[upper].deepest, -10e-6);
    }
    // As it came down on it at 0.13 m/s.
    for (const Watch& watch : hands.watches) {
      EXPECT_LE(watch.deepest, 2 * haptics::ContactOptions().stop_depth);
    }
  }
}

TEST(TwoHandsTest, X3WhatOneHandHoldsTheOtherCannotTake) {
  TwoHands hands(Blocks());
  hands.Take(0, kFirst);
  ASSERT_EQ(hands.simulation.physics().placement(kFirst), simulation::Placement::kHeld);
  hands.Take(1, kFirst);
  EXPECT_FALSE(hands.out[1].occurrence.is_valid());
  EXPECT_EQ(hands.out[0].occurrence, kFirst);
  // Once it is let go of, it can.
  hands.states[0].is_gripping = false;
  hands.states[1].is_gripping = false;
  hands.Run(0.2);
  hands.Take(1, kFirst);
  EXPECT_EQ(hands.out[1].occurrence, kFirst);
  std::vector<std::pair<simulation::SimulationEvent::Kind, std::size_t>> told;
  for (const simulation::SimulationEvent& event : hands.events.events) {
    if (event.kind != simulation::SimulationEvent::Kind::kState) {
      told.emplace_back(event.kind, event.hand);
    }
  }
  using Kind = simulation::SimulationEvent::Kind;
  const std::vector<std::pair<Kind, std::size_t>> expected{
      {Kind::kTaken, 0}, {Kind::kDropped, 0}, {Kind::kTaken, 1}};
  EXPECT_EQ(told, expected);
}

TEST(TwoHandsTest, X7EitherHandPushesALoosePart) {
  for (const std::size_t hand : {0u, 1u}) {
    SCOPED_TRACE(hand);
    TwoHands hands(Blocks());
    hands.Take(1 - hand, kSecond);
    hands.Take(hand, kFirst);
    const Vec3 p_before = hands.CentreOf(kThird);
    // Beside the third block, 5 mm away and 2 mm over the table, then 15 mm on.
    const auto move = [&](const Vec3& v, double time) {
      hands.Run(time, hand == 0 ? v : Vec3::Zero(), hand == 1 ? v : Vec3::Zero());
    };
    move(Vec3(0, 0, 0.1), 0.6);
    const Vec3 n = Vec3(p_before - hands.states[1 - hand].X_DH.p()).cwiseProduct(Vec3(1, 1, 0));
    const Vec3 away = std::abs(n.x()) > std::abs(n.y()) ? Vec3(std::copysign(1, n.x()), 0, 0)
                                                        : Vec3(0, std::copysign(1, n.y()), 0);
    const Vec3 p_beside = p_before - (2 * kHalf + 5e-3) * away + Vec3(0, 0, 0.06);
    move(p_beside - hands.states[hand].X_DH.p(), 1.0);
    move(Vec3(0, 0, -0.058), 1.0);
    move(Vec3::Zero(), 0.2);
    move(0.02 * away, 1.0);
    move(Vec3::Zero(), 0.3);
    EXPECT_GT((hands.CentreOf(kThird) - p_before).dot(away), 10e-3);
    EXPECT_NEAR(hands.CentreOf(kThird).z(), p_before.z(), 0.1e-3);
    EXPECT_LE(hands.watches[hand].deepest, haptics::ContactOptions().stop_depth);
  }
}

TEST(TwoHandsTest, X3OneHandCatchesWhatTheOtherDrops) {
  for (const std::size_t dropper : {0u, 1u}) {
    SCOPED_TRACE(dropper);
    TwoHands hands(Blocks());
    hands.Take(dropper, kFirst);
    const Vec3 up(0, 0, 0.1);
    hands.Run(1.0, dropper == 0 ? up : Vec3::Zero(), dropper == 1 ? up : Vec3::Zero());
    const Vec3 p_held = hands.CentreOf(kFirst) + Vec3(0, 0, 0.1);
    hands.PutHand(1 - dropper, p_held - Vec3(0, 0, 15e-3));
    hands.states[dropper].is_gripping = false;
    hands.Run(0.05);
    hands.states[1 - dropper].is_gripping = true;
    hands.Run(0.5);
    EXPECT_EQ(hands.out[1 - dropper].occurrence, kFirst);
    EXPECT_EQ(hands.simulation.physics().placement(kFirst), simulation::Placement::kHeld);
    EXPECT_NEAR(hands.out[1 - dropper].X_WD.p().z(), p_held.z() - 15e-3, 20e-3);
    EXPECT_TRUE(hands.watches[1 - dropper].is_finite);
    EXPECT_LE(hands.watches[1 - dropper].largest_jump, 0.5);
  }
}

TEST(TwoHandsTest, WithOneOperatorItIsTheSimulationOfOneHand) {
  const auto& model = simulation::testing::PegInBlockModel();
  const haptics::TickOptions options;
  simulation::Simulation one(model, options);
  simulation::Simulation two(model, std::vector{options, options});
  std::vector<std::string> digests;
  for (simulation::Simulation* simulation : {&one, &two}) {
    SimulatedPerson person({}, 1, simulation::StartOfHand(*model));
    Watch watch;
    simulation::AssemblyRun run(simulation, &person, &watch);
    (void)simulation::RunLockstep(run.MakeExecution(&person, 30));
    EXPECT_TRUE(run.is_done());
    ASSERT_GT(watch.largest_force, 1);
    digests.push_back(watch.Hex());
  }
  EXPECT_EQ(digests[0], digests[1]);
}

/** Has a person bring a part to its place. */
void Assign(const simulation::Simulation& simulation, OccurrenceId id, SimulatedPerson* person) {
  const simulation::Body& body = simulation.model().bodies[id.index()];
  const Pose X_BG(body.mass.p_BoBcm_B);
  simulation::PersonTask task;
  task.occurrence = id;
  task.p_BG = X_BG.p();
  task.X_WG_start = simulation.physics().pose(id) * X_BG;
  task.X_WG_goal = body.X_WB_goal * X_BG;
  task.centre_W = simulation.model().centre_W;
  task.transfer_radius = simulation.model().transfer_radius;
  ASSERT_TRUE(person->Assign(task));
}

/** A person with an emulated device in the hand, behind the driver of its vendor. */
struct Person {
  Person(const char* driver, const char* profile, std::uint64_t seed,
         const simulation::Model& model)
      : emulator(Start(driver, profile)),
        device(*device::OpenDevice(emulator->address(), emulator->surroundings())),
        options(simulation::MakeTickOptions(device->info(), model, {})),
        person({}, seed, simulation::StartOfHand(model)),
        hand(&person, emulator.get(), device.get(), false) {}

  static std::unique_ptr<device::Emulator> Start(const char* driver, const char* profile) {
    device::EmulatorOptions options;
    options.profile = device::FindProfile(profile)->profile;
    return *device::StartEmulator(driver, options);
  }

  std::unique_ptr<device::Emulator> emulator;
  std::unique_ptr<device::Device> device;
  haptics::TickOptions options;
  SimulatedPerson person;
  PersonAtDevice hand;
};

/** What reaches the hands. */
class Forces final : public simulation::Sink {
 public:
  void OnTick(std::size_t hand, const DeviceState&,
              const haptics::TickOutput& out) noexcept override {
    largest[hand] = std::max(largest[hand], out.F_H_D.f.norm());
    ++ticks[hand];
  }

  void OnEvent(const simulation::SimulationEvent& event) override {
    if (event.kind == simulation::SimulationEvent::Kind::kDropped) {
      was_seated[event.hand] = was_seated[event.hand] || event.was_seated;
    }
  }

  std::array<double, 2> largest{};
  std::array<std::uint64_t, 2> ticks{};
  std::array<bool, 2> was_seated{};
};

TEST(TwoHandsTest, TwoPersonsAtTwoDevicesWorkAtOnceAndEveryTickRunsAgain) {  // N8, N9, X4
  const auto& model = Blocks();
  Person left("openhaptics", "touch", 1, *model);
  Person right("haply", "inverse3", 2, *model);
  simulation::Simulation simulation(model, std::vector{left.options, right.options});
  simulation::TickLog log(100'000);
  simulation.KeepLog(&log);
  Assign(simulation, kFirst, &left.person);
  Assign(simulation, kThird, &right.person);
  Forces forces;
  simulation::Execution execution;
  execution.simulation = &simulation;
  execution.hands = {&left.hand, &right.hand};
  execution.sink = &forces;
  execution.log = &log;
  int steps = 0;
  execution.advance = [&] {  // in between, somebody stops the forces for a tenth of a second
    ++steps;
    simulation.StopForces(steps > 100 && steps <= 110);
  };
  execution.is_done = [&] {
    return left.person.finished_count() + right.person.finished_count() == 2;
  };
  execution.limit_ns = 30'000'000'000;
  const simulation::ExecutionReport report = simulation::RunLockstep(execution);
  EXPECT_TRUE(execution.is_done());
  EXPECT_EQ(forces.ticks[0], report.ticks);
  EXPECT_EQ(forces.ticks[1], report.ticks);
  EXPECT_EQ(report.compute.count(), report.ticks);
  for (std::size_t hand = 0; hand < 2; ++hand) {
    EXPECT_GT(forces.largest[hand], 0.5) << hand;  // the weight at least
    EXPECT_LE(forces.largest[hand], simulation.options(hand).device.max_force + 1e-9);
    EXPECT_TRUE(forces.was_seated[hand]) << hand;
  }
  EXPECT_GT(left.emulator->device().truth().commands, 1000u);
  EXPECT_GT(right.emulator->device().truth().commands, 1000u);
  simulation::Simulation again(model, std::vector{left.options, right.options});
  ASSERT_EQ(log.tick_count(), 2 * report.ticks);
  ASSERT_TRUE(log.tick(2 * 1050).is_stopped);
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    ASSERT_EQ(log.tick(i).hand, i % 2);
    ASSERT_EQ(again.haptics().ReplayTick(log, i).F_H_D.f, log.tick(i).F_H_D.f) << i;
  }
}

/** Two blocks, 100 mm apart, and a peg in each. */
std::shared_ptr<const simulation::Model> PegsInBlocks() {
  product::Product product;
  product.name = "rigs";
  const auto block = sequence::testing::AddPart(
      &product, "block",
      contact::testing::Cup(sequence::testing::kBoreRadius, 15e-3, sequence::testing::kFloor,
                            sequence::testing::kBlockHeight));
  const auto peg =
      sequence::testing::AddPart(&product, "peg",
                                 contact::testing::Shaft(sequence::testing::kBoreRadius,
                                                         sequence::testing::kPegLength, 20e-6));
  for (int i = 0; i < 2; ++i) {
    const std::string number = std::to_string(i);
    sequence::testing::Place(&product, block, "block " + number, Pose(Vec3(0.1 * i, 0, 0)));
    sequence::testing::Place(&product, peg, "peg " + number,
                             Pose(Vec3(0.1 * i, 0, sequence::testing::kFloor)));
  }
  sequence::testing::Complete(&product);
  Diagnostics diagnostics;
  return *simulation::Compile(std::make_shared<product::Product>(product),
                              simulation::testing::FastOptions(), &diagnostics);
}

/** Counts how the hands were full. */
class FullHands final : public simulation::Sink {
 public:
  void OnTick(std::size_t hand, const DeviceState&,
              const haptics::TickOutput& out) noexcept override {
    is_full_[hand] = out.occurrence.is_valid();
    both += hand == 1 && is_full_[0] && is_full_[1] ? 1 : 0;
  }

  void OnEvent(const simulation::SimulationEvent& event) override {
    if (event.kind == simulation::SimulationEvent::Kind::kTaken) {
      taken.push_back(event.hand);
    }
  }

  int both{0};  ///< Periods with a part in either hand.
  std::vector<std::size_t> taken;

 private:
  std::array<bool, 2> is_full_{};
};

/** Two simulated persons without devices, who assemble a model. */
struct Pair {
  explicit Pair(const std::shared_ptr<const simulation::Model>& model)
      : simulation(model, std::vector<haptics::TickOptions>(2)),
        left({}, 1, StartOfHand(*model)),
        right({}, 2, StartOfHand(*model)),
        run(&simulation, simulation::TaskOperators{&left, &right}, &hands) {
    (void)RunLockstep(run.MakeExecution({&left, &right}, 60));
    EXPECT_TRUE(run.is_done());
    for (const simulation::PartResult& part : run.results()) {
      EXPECT_TRUE(part.is_seated) << part.reason;
    }
  }

  simulation::Simulation simulation;
  SimulatedPerson left;
  SimulatedPerson right;
  FullHands hands;
  simulation::AssemblyRun run;
};

TEST(TwoPersonsTest, WorkAtOnceWhereTheirWaysInAreApart) {
  const Pair pair(PegsInBlocks());
  EXPECT_GT(pair.hands.both, 100);
  EXPECT_EQ(pair.hands.taken, (std::vector<std::size_t>{0, 1, 0}));
}

TEST(TwoPersonsTest, TakeTurnsWhereOnePartIsInTheOthersWay) {
  Diagnostics diagnostics;
  const Pair pair(
      *simulation::Compile(std::make_shared<product::Product>(sequence::testing::CoinUnderLid()),
                           simulation::testing::FastOptions(), &diagnostics));
  EXPECT_EQ(pair.hands.both, 0);
  EXPECT_EQ(pair.hands.taken, (std::vector<std::size_t>{0, 1}));
}

TEST(TwoPersonsTest, WhatAnotherHandHasPutInItsPlaceIsDone) {
  const auto& model = Blocks();
  simulation::Simulation simulation(model, std::vector<haptics::TickOptions>(2));
  const OccurrenceId base = model->sequence.steps.front().occurrence;
  ASSERT_NE(base, kSecond);
  SimulatedPerson by_itself({}, 1,
                            simulation::StartOfHand(*model));  // its tasks do not come from the run
  SimulatedPerson partner({}, 2, simulation::StartOfHand(*model));
  Assign(simulation, kSecond, &by_itself);
  simulation::AssemblyRun run(&simulation, simulation::TaskOperators{nullptr, &partner}, nullptr);
  simulation::Execution execution = run.MakeExecution({&by_itself, &partner}, 60);
  execution.advance = [&] {
    if (by_itself.finished_count() > 0) {
      run.Advance();
    }
  };
  (void)simulation::RunLockstep(execution);
  ASSERT_TRUE(run.is_done());
  ASSERT_EQ(run.results().size(), 3u);
  for (const simulation::PartResult& part : run.results()) {
    EXPECT_TRUE(part.is_seated) << part.reason;
    EXPECT_EQ(part.reason, "");
    if (part.occurrence != base) {
      EXPECT_EQ(part.hand, part.occurrence == kSecond ? 0u : 1u);
    }
  }
  EXPECT_EQ(partner.finished_count(), 1);
}

}  // namespace
}  // namespace hvas::person
