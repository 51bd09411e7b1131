// What a device is given after a pause of the program: N6. Nothing that was computed before it.

#include "haptics/write_pace.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "device/device.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"
#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using spatial::Wrench;

constexpr std::int64_t kMs = 1'000'000;
const Wrench kPush{Vec3(0, 0.1, 0), Vec3(3, 0, 0)};

static_assert(noexcept(std::declval<WritePace&>().Begin(0)));
static_assert(noexcept(std::declval<WritePace&>().Admit(std::declval<const Wrench&>(), 0)));

TEST(WritePace, GapIsTheTimeSinceTheLastWrite) {
  WritePace pace;
  EXPECT_EQ(pace.Begin(5000 * kMs), 0) << "there was none";
  EXPECT_EQ(pace.Admit(kPush, 5001 * kMs).f, kPush.f);
  EXPECT_EQ(pace.Begin(5002 * kMs), kMs);
  EXPECT_EQ(pace.Admit(kPush, 5002 * kMs).f, kPush.f);
  EXPECT_EQ(pace.Begin(5302 * kMs), 300 * kMs);
  EXPECT_EQ(pace.Admit(kPush, 5302 * kMs).f, kPush.f) << "the gate knows of the gap";
}

TEST(WritePace, ClockThatWentBackIsAStall) {
  WritePace pace;
  (void)pace.Begin(5000 * kMs);
  (void)pace.Admit(kPush, 5000 * kMs);
  EXPECT_TRUE(SafetyGate::IsStall(pace.Begin(4000 * kMs)));
  (void)pace.Admit(kPush, 4000 * kMs);
  (void)pace.Begin(4001 * kMs);
  EXPECT_EQ(pace.Admit(kPush, 3000 * kMs).f, Vec3::Zero());
}

// The thread was kept waiting after the gate had let a wrench through.
TEST(WritePace, WrenchOfBeforeAStallIsNotWrittenAfterIt) {
  for (const std::int64_t late_ms : {0, 1, 15}) {
    for (const std::int64_t stall_ms : {21, 50, 5000}) {
      WritePace pace;
      (void)pace.Begin(1000 * kMs);
      (void)pace.Admit(kPush, 1000 * kMs);
      const std::int64_t begin_ns = (1001 + late_ms) * kMs;
      EXPECT_FALSE(SafetyGate::IsStall(pace.Begin(begin_ns)));
      const Wrench written = pace.Admit(kPush, begin_ns + stall_ms * kMs);
      EXPECT_EQ(written.f, Vec3::Zero());
      EXPECT_EQ(written.t, Vec3::Zero());
      const std::int64_t next_ns = begin_ns + (stall_ms + 1) * kMs;
      EXPECT_EQ(pace.Begin(next_ns), WritePace::kUnknownNs) << "the gate has to start from zero";
      EXPECT_EQ(pace.Admit(kPush, next_ns).f, kPush.f);
      EXPECT_EQ(pace.Begin(next_ns + kMs), kMs);
    }
  }
}

TEST(WritePace, WriteThatIsLateInAllIsWithheldThoughNeitherHalfWas) {
  WritePace pace;
  (void)pace.Begin(1000 * kMs);
  (void)pace.Admit(kPush, 1000 * kMs);
  EXPECT_FALSE(SafetyGate::IsStall(pace.Begin(1015 * kMs)));
  EXPECT_EQ(pace.Admit(kPush, 1030 * kMs).f, Vec3::Zero());
}

GateInput MakePush(const Vec3& f, double dt, std::int64_t since_write_ns) {
  GateInput input;
  input.F.f = f;
  input.F.t = 0.02 * f;
  input.dt = dt;
  input.since_write_ns = since_write_ns;
  return input;
}

/** Limits of a real device whose motors stay cold. */
SafetyLimits MakeRealLimits() {
  SafetyLimits limits = MakeSafetyLimits(device::DeviceProfile());
  limits.continuous_force = limits.continuous_torque = SafetyLimits::kNever;
  return limits;
}

// The tick of a session says that its period has passed, a trial how much time really did.
TEST(SafetyGate, AfterAStallTheForceStartsFromZeroAndSoftly) {
  const SafetyLimits limits = MakeRealLimits();
  for (const double rate_hz : {1000.0, 2000.0, 4000.0, 8000.0}) {
    const double period = 1 / rate_hz;
    const auto period_ns = static_cast<std::int64_t>(1e9 * period);
    for (const double gap : {0.021, 0.05, 0.2, 1.0, 5.0}) {
      for (const bool says_gap : {false, true}) {
        SCOPED_TRACE(::testing::Message() << rate_hz << " Hz, " << gap << " s, " << says_gap);
        SafetyGate gate(limits);
        const Vec3 push(0, 5, 0);
        for (int i = 0; i < 2 * rate_hz; ++i) {
          (void)gate.Pass(MakePush(push, period, period_ns));
        }
        ASSERT_EQ(gate.Pass(MakePush(push, period, period_ns)).f, push);
        Wrench last;
        for (int i = 0; i < rate_hz; ++i) {
          const bool is_first = i == 0;
          const auto since_ns = is_first ? static_cast<std::int64_t>(1e9 * gap) : period_ns;
          const Wrench out =
              gate.Pass(MakePush(push, is_first && says_gap ? gap : period, since_ns));
          EXPECT_EQ((gate.actions() & kGateStalled) != 0, is_first);
          const double time = is_first && says_gap ? 2e-3 : period;
          ASSERT_LE(out.f.norm() - last.f.norm(), limits.engage_force_rate * time + 1e-12) << i;
          ASSERT_LE(out.t.norm() - last.t.norm(), limits.engage_torque_rate * time + 1e-12) << i;
          ASSERT_LE(out.f.norm(),
                    limits.max_force * (i * period + 2e-3) / limits.soft_start_time + 1e-9);
          last = out;
        }
        EXPECT_EQ(last.f, push) << "it is back after the soft start";
      }
    }
  }
}

TEST(SafetyGate, GapOfTwentyMillisecondsIsNoStall) {
  SafetyGate gate(MakeRealLimits());
  const Vec3 push(0, 5, 0);
  for (int i = 0; i < 2000; ++i) {
    (void)gate.Pass(MakePush(push, 1e-3, kMs));
  }
  EXPECT_EQ(gate.Pass(MakePush(push, 1e-3, 20 * kMs)).f, push);
  EXPECT_EQ(gate.actions() & kGateStalled, 0u);
  for (const std::int64_t since_ns : {20 * kMs + 1, std::int64_t{-1}, WritePace::kUnknownNs,
                                      std::numeric_limits<std::int64_t>::min()}) {
    EXPECT_LT(gate.Pass(MakePush(push, 1e-3, since_ns)).f.norm(), 0.1) << since_ns;
    EXPECT_EQ(gate.actions() & kGateStalled, kGateStalled) << since_ns;
  }
}

// A loop that is late, but not for long enough to be a stall, does not let a step through either.
TEST(SafetyGate, LateWriteChangesTheForceNoFasterThanOneInTime) {
  const SafetyLimits limits = MakeRealLimits();
  SafetyGate gate(limits);
  for (int i = 0; i < 2000; ++i) {
    (void)gate.Pass(MakePush(Vec3(0, 1, 0), 1e-3, kMs));
  }
  const Wrench out = gate.Pass(MakePush(Vec3(0, 7, 0), 19e-3, 19 * kMs));
  EXPECT_LE(out.f.y(), 1 + limits.max_force_rate * 2e-3 + 1e-9);
  // But a cut is as quick as ever.
  GateInput cut = MakePush(Vec3(0, 7, 0), 19e-3, 19 * kMs);
  cut.is_stopped = true;
  EXPECT_EQ(gate.Pass(cut).f, Vec3::Zero());
}

TEST(SafetyGate, LatchOutlivesAStall) {
  SafetyLimits limits = MakeRealLimits();
  limits.kick.jerk = limits.kick.blow = testing::kInf;
  SafetyGate gate(limits);
  GateInput input = MakePush(Vec3(2, 0, 0), 1e-3, kMs);
  for (int i = 0; !gate.is_latched(); ++i) {
    ASSERT_LT(i, 3000);
    const double phase = 2 * M_PI * 40 * i * 1e-3;
    input.F.f.x() = 2 + std::sin(phase);
    input.V.v.x() = 0.1 * std::cos(phase);
    (void)gate.Pass(input);
  }
  (void)gate.Pass(MakePush(Vec3(2, 0, 0), 1e-3, 1000 * kMs));
  EXPECT_TRUE(gate.is_latched());
}

// The hand goes 0.3 m while nothing holds it: that is no work of the force that was written last,
// in neither direction, and no speed.
TEST(PassivityController, MotionDuringAStallIsNobodysWork) {
  const device::DeviceProfile profile;
  for (const double away : {0.3, -0.3}) {
    PassivityController controller = MakePassivityController(profile, 1e-3);
    const Wrench push{Vec3::Zero(), Vec3(2, 0, 0)};
    double x = 0;
    for (int i = 0; i < 300; ++i) {
      x -= 1e-4;  // The hand works against the force.
      controller.Write(controller.Limit(spatial::Pose(Vec3(x, 0, 0)), push, 0, 0, 1e-3));
    }
    const double before = controller.force().energy();
    controller.ForgetWritten();
    const Wrench out = controller.Limit(spatial::Pose(Vec3(x + away, 0, 0)), push, 0, 0, 1e-3);
    EXPECT_EQ(controller.force().energy(), before);
    EXPECT_NEAR(out.f.x(), push.f.x(), 0.5 * push.f.x());
    controller.Write(out);
  }
}

}  // namespace
}  // namespace hvas::haptics
