// The loop of a session after a pause of the process: N6. The first write to the device is no force
// that was computed before, and the force comes back softly.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "base/loop_clock.h"
#include "person/person_at_device.h"
#include "person/test/direct_emulator.h"
#include "person/test/session.h"
#include "simulation/device_session.h"
#include "simulation/haptic_loop.h"
#include "simulation/test/small_models.h"
#include "simulation/tick_log.h"

namespace hvas::person {
namespace {

using simulation::testing::PressedPegModel;
using testing::DirectDevice;
using testing::DirectEmulator;
using testing::Watch;

/** The machine's clock as the test has it: it can leap between two readings. */
class LeapingClock final : public LoopClock {
 public:
  [[nodiscard]] std::int64_t NowNs() const noexcept override {
    const std::int64_t now_ns = now_ns_;
    now_ns_ += leap_ns_;
    leap_ns_ = 0;
    return now_ns;
  }

  void Advance(std::int64_t step_ns) { now_ns_ += step_ns; }

  /** Stands still after the next reading. */
  void LeapAfterReading(std::int64_t leap_ns) { leap_ns_ = leap_ns; }

  void WaitUntil(std::int64_t, const std::function<bool()>&) noexcept override {}

  void Enter() noexcept override {}

  void Leave() noexcept override {}

  void WakeAll() noexcept override {}

  [[nodiscard]] bool is_steered() const noexcept override { return false; }

 private:
  mutable std::int64_t now_ns_{kNsPerSecond};
  mutable std::int64_t leap_ns_{0};
};

/** An operator that also notes what is written to its device. */
class NotedOperator final : public simulation::Operator {
 public:
  explicit NotedOperator(simulation::Operator* inner) : inner_(inner) {}

  device::DeviceState Step(const simulation::OperatorInput& input) noexcept override {
    return inner_->Step(input);
  }

  void Apply(const spatial::Wrench& F_H_D) noexcept override {
    written = F_H_D;
    inner_->Apply(F_H_D);
  }

  spatial::Wrench written;

 private:
  simulation::Operator* inner_;
};

/** The simulated person assembles through an emulated device, in the loop of a live session whose
 clock is the test's. */
class StalledSession {
 public:
  explicit StalledSession(double rate_hz)
      : emulator_(device::FindProfile("virtuose")->profile),
        device_(&emulator_.device()),
        options_(simulation::MakeTickOptions(device_.info(), *model_, {0, rate_hz})),
        simulation_(model_, options_),
        person_(MakePersonOptions(options_), 1, simulation::StartOfHand(*model_)),
        hand_(&person_, &emulator_, &device_, false),
        noted_(&hand_),
        run_(&simulation_, &person_, &watch_),
        execution_(run_.MakeExecution(&noted_, 1e6)),
        log_(200'000) {
    simulation_.KeepLog(&log_);
    execution_.log = &log_;
    execution_.is_live = true;
    execution_.sheds_load = false;
    execution_.clock = &clock_;
    period_ns_ = simulation::CalcPeriod(simulation_);
    loop_ = std::make_unique<simulation::HapticLoop>(execution_, &report_);
    StepPhysics();
  }

  void Tick() {
    clock_.Advance(period_ns_);
    (void)loop_->Tick(0);
    if (loop_->t_ns() % simulation::Simulation::kPhysicsStepNs == 0) {
      StepPhysics();
    }
  }

  /** Goes on until a force of some size has acted for 50 ms; false when the session is over. */
  [[nodiscard]] bool RunUntilPressed(double force) {
    std::int64_t since_ns = loop_->t_ns();
    while (loop_->t_ns() - since_ns < 50'000'000) {
      if (execution_.is_done() || loop_->t_ns() > 60 * kNsPerSecond) {
        return false;
      }
      Tick();
      since_ns = written() > force ? since_ns : loop_->t_ns();
    }
    return true;
  }

  LeapingClock& clock() { return clock_; }

  [[nodiscard]] double written() const { return noted_.written.f.norm(); }

  [[nodiscard]] double turning() const { return noted_.written.t.norm(); }

  [[nodiscard]] const haptics::SafetyLimits& limits() const { return *options_.limits; }

  [[nodiscard]] double period_s() const { return options_.dt; }

  [[nodiscard]] const simulation::TickLog& log() const { return log_; }

  [[nodiscard]] const haptics::TickOptions& options() const { return options_; }

 private:
  void StepPhysics() {
    simulation_.physics().Step(execution_.sink);
    execution_.advance();
  }

  std::shared_ptr<const simulation::Model> model_{PressedPegModel()};
  DirectEmulator emulator_;
  DirectDevice device_;
  haptics::TickOptions options_;
  simulation::Simulation simulation_;
  SimulatedPerson person_;
  PersonAtDevice hand_;
  NotedOperator noted_;
  Watch watch_;
  simulation::AssemblyRun run_;
  simulation::Execution execution_;
  simulation::TickLog log_;
  LeapingClock clock_;
  simulation::ExecutionReport report_;
  std::int64_t period_ns_{0};
  std::unique_ptr<simulation::HapticLoop> loop_;
};

constexpr double kPressed = 2;  // [N] that acts when the process stands still.

/** Expects that the force begins at nothing with the next tick, and grows as at any soft start. */
void ExpectSoftStart(StalledSession* session) {
  double before = 0;
  double turning_before = 0;
  for (int i = 0; i * session->period_s() < 0.1; ++i) {
    session->Tick();
    const haptics::SafetyLimits& limits = session->limits();
    ASSERT_LE(session->written() - before, limits.engage_force_rate * session->period_s() + 1e-9)
        << i;
    ASSERT_LE(session->turning() - turning_before,
              limits.engage_torque_rate * session->period_s() + 1e-9)
        << i;
    before = session->written();
    turning_before = session->turning();
  }
}

class StallTest : public ::testing::TestWithParam<double> {};

TEST_P(StallTest, ForceStartsFromZeroAfterEveryGap) {
  StalledSession session(GetParam());
  for (const double gap : {0.021, 0.05, 0.2, 1.0, 5.0}) {
    SCOPED_TRACE(gap);
    ASSERT_TRUE(session.RunUntilPressed(kPressed));
    session.clock().Advance(std::llround(1e9 * gap));
    ExpectSoftStart(&session);
  }
  ASSERT_TRUE(session.RunUntilPressed(kPressed));
  session.clock().Advance(-500'000'000);
  ExpectSoftStart(&session);
}

// The thread is kept waiting between the gate and the device.
TEST_P(StallTest, ForceOfBeforeAGapIsNotWrittenAfterIt) {
  StalledSession session(GetParam());
  for (const double gap : {0.021, 1.0}) {
    ASSERT_TRUE(session.RunUntilPressed(kPressed));
    session.clock().LeapAfterReading(std::llround(1e9 * gap));
    session.Tick();
    EXPECT_EQ(session.written(), 0) << gap;
    ExpectSoftStart(&session);
  }
}

TEST_P(StallTest, ShorterGapsChangeNothing) {
  StalledSession session(GetParam());
  ASSERT_TRUE(session.RunUntilPressed(kPressed));
  session.clock().Advance(15'000'000);
  session.Tick();
  EXPECT_GT(session.written(), 0.5 * kPressed);
}

// N9: the gap is an input of the tick.
TEST_P(StallTest, EveryTickRunsAgainBitForBit) {
  StalledSession session(GetParam());
  ASSERT_TRUE(session.RunUntilPressed(kPressed));
  session.clock().Advance(300'000'000);
  ASSERT_TRUE(session.RunUntilPressed(kPressed));
  simulation::Simulation again(PressedPegModel(), session.options());
  const simulation::TickLog& log = session.log();
  for (std::size_t i = 0; i < log.tick_count(); ++i) {
    ASSERT_EQ(again.haptics().ReplayTick(log, i).F_H_D.f, log.tick(i).F_H_D.f) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Rates, StallTest, ::testing::Values(1000.0, 2000.0, 4000.0, 8000.0),
                         [](const auto& instance) {
                           return std::to_string(static_cast<int>(instance.param)) + "Hz";
                         });

// What is steered never stands still: each tick is one period after the one before.
TEST(SteeredStallTest, SteeredTimeHasNoGaps) {
  SteeredClock clock;
  haptics::WritePace pace;
  for (int i = 0; i < 100; ++i) {
    clock.Advance(kNsPerSecond / 1000);
    EXPECT_FALSE(haptics::SafetyGate::IsStall(pace.Begin(clock.NowNs())));
    EXPECT_EQ(pace.Admit({Vec3::Zero(), Vec3(1, 0, 0)}, clock.NowNs()).f.x(), 1);
  }
  clock.Advance(21'000'000);
  EXPECT_TRUE(haptics::SafetyGate::IsStall(pace.Begin(clock.NowNs())));
}

}  // namespace
}  // namespace hvas::person
