#include <gtest/gtest.h>

#include "person/test/session.h"
#include "simulation/flight_recorder.h"
#include "simulation/load_shedder.h"
#include "simulation/realtime_thread.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using simulation::testing::PegInBlockModel;
using testing::Session;

constexpr std::int64_t kPeriodNs = 1'000'000;

TEST(LoadShedderTest, X4LevelsLeaveOutMoreAndMoreAndPointsFirst) {
  for (std::size_t i = 1; i < simulation::kEffortLevels.size(); ++i) {
    EXPECT_LT(simulation::kEffortLevels[i].point_budget,
              simulation::kEffortLevels[i - 1].point_budget);
    EXPECT_LE(simulation::kEffortLevels[i].iterations, simulation::kEffortLevels[i - 1].iterations);
  }
  EXPECT_EQ(simulation::kEffortLevels[1].iterations, simulation::kEffortLevels[0].iterations);
  EXPECT_TRUE(simulation::kEffortLevels[2].wakes_bodies);
  EXPECT_FALSE(simulation::kEffortLevels.back().wakes_bodies);
}

TEST(LoadShedderTest, ShedsBeforeTheDeadlineAndComesBackWhenItIsQuiet) {
  constexpr std::int64_t kLongestNs = 200'000;
  simulation::LoadShedder shedder(kPeriodNs);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(shedder.Update(kLongestNs), 0) << "so much is allowed";
  }
  EXPECT_EQ(shedder.Update(kLongestNs + 1), 1);
  // It waits for the change to show before it goes on.
  EXPECT_EQ(shedder.Update(kLongestNs + 1), 1);
  EXPECT_EQ(shedder.Update(kLongestNs + 1), 1);
  EXPECT_EQ(shedder.Update(kLongestNs + 1), 2);
  for (int i = 0; i < 100; ++i) {
    shedder.Update(2 * kPeriodNs);
  }
  EXPECT_EQ(shedder.level(), 3);
  int ticks_to_full = 0;
  while (shedder.Update(kLongestNs / 2) > 0) {
    ++ticks_to_full;
  }
  EXPECT_NEAR(ticks_to_full, 1500, 3) << "half a second a level";
}

TEST(LoadShedderTest, ATickOfAShortPeriodMayTakeHalfOfIt) {
  constexpr std::int64_t kShortNs = 125'000;  // 8 kHz
  simulation::LoadShedder shedder(kShortNs);
  EXPECT_EQ(shedder.Update(kShortNs / 2), 0);
  for (std::int64_t t_ns = 0; t_ns < 4'000'000 && shedder.level() == 0; t_ns += kShortNs) {
    shedder.Update(kShortNs / 2 + 1);
  }
  EXPECT_EQ(shedder.level(), 1);
}

simulation::FlightTick TickAt(std::int64_t i) {
  simulation::FlightTick tick;
  tick.device.t_ns = i * kPeriodNs;
  return tick;
}

TEST(FlightRecorderTest, KeepsTheLastSecondAndATenthAfterAFault) {  // N6
  simulation::FlightRecorder recorder(1000);
  for (std::int64_t i = 0; i < 5000; ++i) {
    recorder.Keep(TickAt(i));
    if (i == 3000) {
      recorder.Trigger();
    }
    const auto ticks = recorder.Take();
    if (i == 3100) {
      ASSERT_EQ(ticks.size(), 1100u);
      for (std::size_t k = 0; k < ticks.size(); ++k) {
        EXPECT_EQ(ticks[k].device.t_ns, (2001 + static_cast<std::int64_t>(k)) * kPeriodNs);
      }
    } else {
      ASSERT_TRUE(ticks.empty()) << i;
    }
  }
  EXPECT_EQ(recorder.unrecorded(), 0u);
}

TEST(FlightRecorderTest, FurtherFaultsWhileItIsBusyAreCounted) {
  simulation::FlightRecorder recorder(1000);
  for (std::int64_t i = 0; i < 300; ++i) {
    recorder.Keep(TickAt(i));
    if (i == 50 || i == 60 || i == 200) {  // the second during the first, the third untaken
      recorder.Trigger();
    }
  }
  EXPECT_EQ(recorder.unrecorded(), 2u);
  EXPECT_EQ(recorder.Take().size(), 151u);
  recorder.Trigger();
  recorder.Finish();  // the session ends before the tenth of a second has passed
  const auto last = recorder.Take();
  ASSERT_FALSE(last.empty());
  EXPECT_EQ(last.back().device.t_ns, 299 * kPeriodNs);
  EXPECT_TRUE(recorder.Take().empty());
}

TEST(RealtimeThreadTest, ReadsTheListOfIsolatedCores) {
  EXPECT_EQ(simulation::FirstCoreOf("2-3,5"), 2);
  EXPECT_EQ(simulation::FirstCoreOf("7"), 7);
  EXPECT_EQ(simulation::FirstCoreOf(""), -1);
  EXPECT_EQ(simulation::FirstCoreOf("none"), -1);
  EXPECT_EQ(simulation::FirstCoreOf("99999999999"), -1);
  EXPECT_EQ(simulation::FirstCoreOf("100000"), -1);
}

TEST(RealtimeThreadTest, SaysWhatWasRefused) {
  simulation::RealtimeGrant grant;
  grant.fifo_refusal = "Operation not permitted";
  grant.is_memory_locked = true;
  EXPECT_EQ(grant.ToString(),
            "normal priority (SCHED_FIFO refused: Operation not permitted), memory locked, no core "
            "to itself");
}

TEST(TickLogTest, EveryTickRunsAgainBitForBit) {  // N9
  const auto model = PegInBlockModel();
  simulation::TickLog log(30'000);
  Session session(model);
  session.simulation.KeepLog(&log);
  simulation::Execution execution = session.MakeExecution(20);
  execution.log = &log;
  (void)simulation::RunLockstep(execution);
  ASSERT_TRUE(session.run.is_done());
  ASSERT_GT(log.tick_count(), 1000u);
  ASSERT_GE(log.command_count(), 2u);  // the base in its fixture, the peg in the hand
  simulation::Simulation again(model, session.simulation.options());
  double largest = 0;
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    const haptics::TickOutput out = again.haptics().ReplayTick(log, i);
    ASSERT_EQ(out.F_H_D.f, log.tick(i).F_H_D.f) << i;
    ASSERT_EQ(out.F_H_D.t, log.tick(i).F_H_D.t) << i;
    largest = std::max(largest, out.F_H_D.f.norm());
  }
  EXPECT_GT(largest, 1);  // something was felt
}

TEST(ContactLimitsTest, TicksOfARunAreCounted) {
  haptics::ContactAccount account;
  account.is_truncated = true;
  simulation::ContactLimits limits;
  limits.Add(account);
  account.is_crowded = true;
  limits.Add(account);
  limits.Add({});
  EXPECT_EQ(limits.truncated_ticks, 2u);
  EXPECT_EQ(limits.crowded_ticks, 1u);
}

TEST(ContactLimitsTest, RunWithFewPointsReportsTicksWithIncompleteContact) {
  const auto truncated = [](int effort_level) {
    Session session(PegInBlockModel());
    session.simulation.haptics().SetEffortLevel(effort_level);
    return simulation::RunLockstep(session.MakeExecution(5)).contact_limits.truncated_ticks;
  };
  EXPECT_EQ(truncated(0), 0u);
  EXPECT_GT(truncated(3), 0u);
}

}  // namespace
}  // namespace hvas::person
