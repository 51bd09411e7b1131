// The loops by the machine's clock: what happens, not when. The other tests of loops steer their
// time.
#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using simulation::testing::PegInBlockModel;
using testing::Session;

constexpr int kRealTime = 4;  // long enough to take the peg up and, in time, to put it in

TEST(RealtimeTest, X4ThreeLoopsShareASession) {
  Session session(PegInBlockModel());
  int physics_steps = 0;
  simulation::Execution execution = session.MakeExecution(kRealTime);
  execution.advance = [&] {
    ++physics_steps;
    session.run.Advance();
  };
  const simulation::ExecutionReport report = simulation::RunRealtime(execution);
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
  const simulation::Frame& frame = session.simulation.Publish();
  EXPECT_EQ(frame.X_WB[0].p(), PegInBlockModel()->bodies[0].X_WB_goal.p());
  EXPECT_GT(frame.t_ns, 0);
  EXPECT_LE(frame.t_ns, report.session_ns);
}

}  // namespace
}  // namespace hvas::person
