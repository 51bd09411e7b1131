#include <gtest/gtest.h>

#include "simulation/test/session.h"
#include "simulation/test/small_products.h"

namespace hvas::simulation {
namespace {

using testing::PegInBlockModel;
using testing::Session;

constexpr int kRealTime = 4;  // long enough to take the peg up and, in time, to put it in

TEST(RealtimeTest, X4ThreeLoopsShareASession) {  // meant for the thread sanitizer
  Session session(PegInBlockModel());
  int physics_steps = 0;
  Execution execution = session.MakeExecution(kRealTime);
  execution.advance = [&] {
    ++physics_steps;
    session.run.Advance();
  };
  const ExecutionReport report = RunRealtime(execution);
  EXPECT_GT(report.ticks, 0u);
  EXPECT_EQ(report.ticks, session.watch.ticks);
  EXPECT_EQ(report.compute.count(), report.ticks);
  EXPECT_EQ(report.wake_up.count(), report.ticks);
  EXPECT_LE(report.late_wake_ups, report.ticks);
  EXPECT_LE(report.overruns, report.ticks);
  EXPECT_TRUE(session.run.is_done() || report.session_ns >= kRealTime * 1'000'000'000L);
  EXPECT_EQ(report.session_ns, static_cast<std::int64_t>(report.ticks) * 1'000'000);
  // Deadlines are absolute: session time is never ahead of the clock.
  EXPECT_GE(report.wall_ns, report.session_ns - 1'000'000);
  EXPECT_GT(physics_steps, 1);
  EXPECT_FALSE(report.scheduling.empty());
  EXPECT_TRUE(session.watch.is_finite);
  // The base is in its fixture, and what was published last is from the end of the session.
  const Frame& frame = session.simulation.Publish();
  EXPECT_EQ(frame.X_WB[0].p(), PegInBlockModel()->bodies[0].X_WB_goal.p());
  EXPECT_GT(frame.t_ns, 0);
  EXPECT_LE(frame.t_ns, report.session_ns);
}

/** Ticks of each hand, and whether all was finite. */
class TicksOfHands final : public Sink {
 public:
  void OnTick(std::size_t hand, const device::DeviceState&,
              const haptics::TickOutput& out) noexcept override {
    ++ticks[hand];
    is_finite = is_finite && out.F_H_W.f.allFinite() && spatial::IsFinite(out.X_WD);
  }

  void OnEvent(const SimulationEvent& event) override {
    has_taken = has_taken || event.kind == SimulationEvent::Kind::kTaken;
  }

  std::uint64_t ticks[2]{};
  bool is_finite{true};
  bool has_taken{false};
};

TEST(RealtimeTest, X3TwoHandsShareASession) {  // X4; meant for the thread sanitizer
  const auto& model = PegInBlockModel();
  Simulation simulation(model, std::vector<haptics::TickOptions>(2));
  SimulatedPerson left({}, 1, StartOfHand(*model));
  SimulatedPerson right({}, 2, StartOfHand(*model));
  TicksOfHands hands;
  AssemblyRun run(&simulation, Persons{&left, &right}, &hands);
  FlightRecorder flight(1000, 2);
  std::size_t hands_in_frame = 0;
  Execution execution = run.MakeExecution({&left, &right}, 2);
  execution.flight = &flight;
  execution.on_frame = [&](const Frame& frame) { hands_in_frame = frame.ticks.size(); };
  const ExecutionReport report = RunRealtime(execution);
  EXPECT_GT(report.ticks, 0u);
  EXPECT_EQ(hands.ticks[0], report.ticks);
  EXPECT_EQ(hands.ticks[1], report.ticks);
  EXPECT_TRUE(hands.is_finite);
  EXPECT_TRUE(hands.has_taken);
  EXPECT_EQ(hands_in_frame, 2u);
}

TEST(RealtimeTest, RunEndsWhenItIsDone) {
  Session session(PegInBlockModel());
  Execution execution = session.MakeExecution(60);
  int steps = 0;
  execution.is_done = [&steps] { return ++steps > 20; };
  const ExecutionReport report = RunRealtime(execution);
  EXPECT_LT(report.session_ns, 60'000'000'000);
}

}  // namespace
}  // namespace hvas::simulation
