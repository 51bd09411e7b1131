// The three loops with their threads, in steered time: nothing is late, however busy the machine
// is.
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "base/clock_place.h"
#include "base/loop_clock.h"
#include "person/simulated_person.h"
#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using simulation::testing::PegInBlockModel;
using testing::Session;

constexpr double kLimit = 60;  // Of the session [s]: more than the peg needs.

/** Runs it with its threads, as fast as they compute. */
simulation::ExecutionReport RunSteered(simulation::Execution execution) {
  SteeredClock clock;
  execution.clock = &clock;
  clock.Enter();
  const ClockDriver driver(&clock);
  const ClockPlace place(&clock);
  return simulation::RunRealtime(execution);
}

TEST(LoopThreadsTest, X4ThreeLoopsShareASession) {  // meant for the thread sanitizer
  Session session(PegInBlockModel());
  std::uint64_t physics_steps = 0;
  std::uint64_t frames = 0;
  simulation::Execution execution = session.MakeExecution(kLimit);
  execution.advance = [&] {
    ++physics_steps;
    session.run.Advance();
  };
  execution.on_frame = [&](const simulation::Frame&) { ++frames; };
  const simulation::ExecutionReport report = RunSteered(execution);
  EXPECT_TRUE(session.run.is_done());
  EXPECT_EQ(report.ticks, session.watch.ticks);
  EXPECT_EQ(report.compute.count(), report.ticks);
  EXPECT_EQ(report.session_ns, static_cast<std::int64_t>(report.ticks) * 1'000'000);
  EXPECT_EQ(report.late_wake_ups, 0u);
  EXPECT_EQ(report.missed_periods, 0u);
  // But for the steps at the beginning and at the end.
  EXPECT_NEAR(static_cast<double>(physics_steps), static_cast<double>(report.ticks) / 10, 3);
  EXPECT_NEAR(static_cast<double>(frames), 30e-9 * static_cast<double>(report.session_ns), 3);
  EXPECT_TRUE(session.watch.is_finite);
  const simulation::Frame& frame = session.simulation.Publish();
  EXPECT_EQ(frame.X_WB[0].p(), PegInBlockModel()->bodies[0].X_WB_goal.p());
  EXPECT_EQ(session.simulation.physics().parts()[1].placement, simulation::Placement::kPlaced);
  EXPECT_LE(frame.t_ns, report.session_ns);
}

/** Ticks of each hand, and whether all was finite. */
class TicksOfHands final : public simulation::Sink {
 public:
  void OnTick(std::size_t hand, const device::DeviceState&,
              const haptics::TickOutput& out) noexcept override {
    ++ticks[hand];
    is_finite = is_finite && out.F_H_W.f.allFinite() && spatial::IsFinite(out.X_WD);
  }

  void OnEvent(const simulation::SimulationEvent& event) override {
    has_taken = has_taken || event.kind == simulation::SimulationEvent::Kind::kTaken;
  }

  std::uint64_t ticks[2]{};
  bool is_finite{true};
  bool has_taken{false};
};

TEST(LoopThreadsTest, X3TwoHandsShareASession) {  // X4; meant for the thread sanitizer
  const auto& model = PegInBlockModel();
  simulation::Simulation simulation(model, std::vector<haptics::TickOptions>(2));
  SimulatedPerson left({}, 1, simulation::StartOfHand(*model));
  SimulatedPerson right({}, 2, simulation::StartOfHand(*model));
  TicksOfHands hands;
  simulation::AssemblyRun run(&simulation, simulation::TaskOperators{&left, &right}, &hands);
  simulation::FlightRecorder flight(1000, 2);
  std::size_t hands_in_frame = 0;
  simulation::Execution execution = run.MakeExecution({&left, &right}, 2);
  execution.flight = &flight;
  execution.on_frame = [&](const simulation::Frame& frame) { hands_in_frame = frame.ticks.size(); };
  const simulation::ExecutionReport report = RunSteered(execution);
  EXPECT_NEAR(static_cast<double>(report.ticks), 2000, 20);
  EXPECT_EQ(hands.ticks[0], report.ticks);
  EXPECT_EQ(hands.ticks[1], report.ticks);
  EXPECT_TRUE(hands.is_finite);
  EXPECT_TRUE(hands.has_taken);
  EXPECT_EQ(hands_in_frame, 2u);
}

TEST(LoopThreadsTest, RunEndsWhileItsTimeStandsStill) {
  Session session(PegInBlockModel());
  SteeredClock clock;
  simulation::Execution execution = session.MakeExecution(kLimit);
  std::atomic<bool> is_over{false};
  execution.is_done = [&is_over] { return is_over.load(); };
  execution.clock = &clock;
  clock.Enter();
  std::thread run([&execution, &clock] {
    const ClockPlace place(&clock);
    (void)simulation::RunRealtime(execution);
  });
  is_over = true;
  clock.WakeAll();
  run.join();
  EXPECT_FALSE(clock.has_threads());
}

}  // namespace
}  // namespace hvas::person
