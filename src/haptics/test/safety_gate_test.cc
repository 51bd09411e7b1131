// The last thing before the device: N6. Fail-safe on missing or broken data.

#include "haptics/safety_gate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using spatial::Wrench;
using testing::kDt;
using testing::kInf;
using testing::kNan;

constexpr double kRounding = 1e-12;

static_assert(noexcept(std::declval<SafetyGate&>().Pass(std::declval<const Wrench&>(),
                                                        std::declval<double>())));

/** Lets a constant wrench through until it has settled. */
Wrench Settle(SafetyGate* gate, const Wrench& wrench) {
  Wrench out;
  for (int i = 0; i < 1000; ++i) {
    out = gate->Pass(wrench, kDt);
  }
  return out;
}

TEST(SafetyGate, PassesWhatIsWithinItsLimitsUntouched) {
  SafetyGate gate({});
  const Wrench wanted{Vec3(0.01, 0, -0.005), Vec3(0.2, -0.1, 0.3)};
  const Wrench out = gate.Pass(wanted, kDt);
  EXPECT_EQ(out.f, wanted.f);
  EXPECT_EQ(out.t, wanted.t);
  EXPECT_EQ(gate.actions(), kGatePassed);
}

TEST(SafetyGate, LimitsTheNormAndKeepsTheDirection) {
  SafetyGate gate({});
  for (const double size : {7.1, 1e3, 1e30, 1e160, 1e308}) {
    const Vec3 direction = Vec3(1, -2, 0.5).normalized();
    const Wrench out = Settle(&gate, {-size * direction, size * direction});
    EXPECT_NEAR(out.f.norm(), gate.limits().max_force, kRounding) << size;
    EXPECT_NEAR(out.t.norm(), gate.limits().max_torque, kRounding) << size;
    EXPECT_NEAR(out.f.normalized().dot(direction), 1, kRounding) << size;
    EXPECT_NEAR(out.t.normalized().dot(direction), -1, kRounding) << size;
    EXPECT_EQ(gate.actions() & kGateMagnitude, kGateMagnitude);
  }
}

// A step comes out as a ramp of 0.4 N/ms in a straight line, and ends exactly at what was wanted.
TEST(SafetyGate, TurnsAStepIntoARamp) {
  SafetyGate gate({});
  const Wrench wanted{Vec3(0, 0.3, 0), Vec3(3, 0, 4)};
  for (int i = 1; i <= 12; ++i) {
    const Wrench out = gate.Pass(wanted, kDt);
    EXPECT_NEAR(out.f.norm(), 0.4 * i, kRounding);
    EXPECT_NEAR((out.f - out.f.norm() * Vec3(0.6, 0, 0.8)).norm(), 0, kRounding);
    EXPECT_EQ(gate.actions() & kGateRate, kGateRate);
  }
  Settle(&gate, wanted);
  EXPECT_EQ(gate.Pass(wanted, kDt).f, wanted.f);
  EXPECT_EQ(gate.actions(), kGatePassed);
}

// A missing pose or a broken computation gives no cached force, but a decay to zero.
TEST(SafetyGate, DecaysToZeroOnWhatIsNotFinite) {
  for (const double bad : {kNan, kInf, -kInf}) {
    for (int k = 0; k < 6; ++k) {
      SafetyGate gate({});
      Settle(&gate, {Vec3(0.2, 0, 0), Vec3(0, 5, 0)});
      Wrench wanted{Vec3(0.2, 0, 0), Vec3(0, 5, 0)};
      (k < 3 ? wanted.f : wanted.t)[k % 3] = bad;
      for (int i = 1; i <= 30; ++i) {
        const Wrench out = gate.Pass(wanted, kDt);
        EXPECT_EQ(gate.actions() & kGateNotFinite, kGateNotFinite);
        EXPECT_NEAR(out.f.y(), std::max(0.0, 5 - 0.4 * i), 1e-9);
        EXPECT_NEAR(out.t.x(), std::max(0.0, 0.2 - 0.02 * i), 1e-9);
      }
      EXPECT_EQ(gate.Pass(wanted, kDt).f, Vec3::Zero());
    }
  }
}

// No time passed, or a clock that went wrong: nothing changes.
TEST(SafetyGate, HoldsWhereNoTimePasses) {
  for (const double dt : {0.0, -1.0, -kInf, kNan}) {
    SafetyGate gate({});
    const Wrench before = Settle(&gate, {Vec3(0.1, 0, 0), Vec3(0, 2, 0)});
    const Wrench out = gate.Pass({Vec3(0, 0.4, 0), Vec3(7, 0, 0)}, dt);
    EXPECT_EQ(out.f, before.f) << dt;
    EXPECT_EQ(out.t, before.t) << dt;
  }
}

/** Any double: ordinary, huge, denormal, zero, not a number. */
double DrawAny(Random* random) {
  switch (random->NextBits() % 8) {
    case 0: {
      const std::uint64_t bits = random->NextBits();
      double x = 0;
      std::memcpy(&x, &bits, sizeof(x));
      return x;
    }
    case 1:
      return random->Uniform(-1, 1) * std::numeric_limits<double>::max();
    case 2:
      return random->Uniform(-4, 4) * std::numeric_limits<double>::denorm_min();
    case 3:
      return random->NextBits() % 4 == 0 ? kNan : 0;
    case 4:
      return random->NextBits() % 8 == 0 ? kInf : 0;
    default:
      return random->Uniform(-20, 20);
  }
}

double DrawTime(Random* random) {
  return random->NextBits() % 4 == 0 ? DrawAny(random) : random->Uniform(0, 2e-3);
}

// N6: whatever comes in, what goes out is finite, within the limits and not too fast.
TEST(SafetyGate, KeepsItsPromisesOverRandomInputs) {
  Random random(7);
  const SafetyLimits limits;
  SafetyGate gate(limits);
  Wrench last;
  int passed = 0;
  int limited = 0;
  int not_finite = 0;
  int at_rate = 0;
  for (int i = 0; i < 100'000; ++i) {
    Wrench wanted;
    for (int k = 0; k < 3; ++k) {
      wanted.f[k] = i % 3 == 0 ? random.Uniform(-0.4, 0.4) : DrawAny(&random);
      wanted.t[k] = i % 3 == 0 ? random.Uniform(-0.02, 0.02) : DrawAny(&random);
    }
    const double dt = DrawTime(&random);
    const double time = dt > 0 ? dt : 0;
    const Wrench out = gate.Pass(wanted, dt);
    ASSERT_TRUE(out.f.allFinite() && out.t.allFinite()) << i;
    ASSERT_LE(out.f.norm(), limits.max_force * (1 + kRounding)) << i;
    ASSERT_LE(out.t.norm(), limits.max_torque * (1 + kRounding)) << i;
    ASSERT_LE((out.f - last.f).norm(), limits.max_force_rate * time * (1 + 1e-9) + kRounding) << i;
    ASSERT_LE((out.t - last.t).norm(), limits.max_torque_rate * time * (1 + 1e-9) + kRounding) << i;
    last = out;
    passed += gate.actions() == kGatePassed ? 1 : 0;
    limited += (gate.actions() & kGateMagnitude) != 0 ? 1 : 0;
    not_finite += (gate.actions() & kGateNotFinite) != 0 ? 1 : 0;
    at_rate += (gate.actions() & kGateRate) != 0 ? 1 : 0;
  }
  // The inputs reach every branch often.
  EXPECT_GT(passed, 100);
  EXPECT_GT(limited, 10'000);
  EXPECT_GT(not_finite, 1'000);
  EXPECT_GT(at_rate, 10'000);
}

static_assert(noexcept(std::declval<SafetyGate&>().Pass(std::declval<const GateInput&>())));
static_assert(noexcept(ListNewActions(0, 0)) && noexcept(ToString(kGatePassed)));

/** Limits of a Touch X, with motors that stand anything. */
SafetyLimits MakeColdLimits() {
  SafetyLimits limits = MakeSafetyLimits(device::DeviceProfile());
  limits.continuous_force = SafetyLimits::kNever;
  limits.continuous_torque = SafetyLimits::kNever;
  return limits;
}

GateInput MakeInput(const Vec3& f) {
  GateInput input;
  input.F.f = f;
  input.dt = kDt;
  return input;
}

/** A gate that has let a force through for two seconds. */
SafetyGate MakePressed(const SafetyLimits& limits, const Vec3& f) {
  SafetyGate gate(limits);
  for (int i = 0; i < 2000; ++i) {
    (void)gate.Pass(MakeInput(f));
  }
  return gate;
}

/** The largest force of `ticks` more, from the last of them on to the first. */
double PassFor(SafetyGate* gate, const GateInput& input, int ticks) {
  double last = 0;
  for (int i = 0; i < ticks; ++i) {
    last = gate->Pass(input).f.norm();
  }
  return last;
}

// h' = (F^2 - h) / tau: a press at the limit ends at the continuous force, and the mean square
// never passes its square.
TEST(ThermalLimit, FallsToWhatTheMotorsStandForEver) {
  ThermalLimit thermal(7.9, 1.75, 1);
  EXPECT_EQ(thermal.limit(), 7.9);
  double last = thermal.limit();
  double energy = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double limit = thermal.limit();
    ASSERT_LE(limit, last);
    last = limit;
    thermal.Heat(limit, kDt);
    energy += limit * limit * kDt;
    ASSERT_LE(thermal.rms(), 1.75 * (1 + 1e-9));
  }
  EXPECT_NEAR(last, 1.75, 1e-3);
  // Never much more heat than one time constant's, however it pushes.
  EXPECT_LT(energy, 1.75 * 1.75 * (10 + 1));
  // Cold again: 5 time constants on, by the closed form.
  for (int i = 0; i < 5000; ++i) {
    thermal.Heat(0, kDt);
  }
  EXPECT_NEAR(thermal.rms(), 1.75 * std::exp(-2.5), 1e-3);
}

TEST(ThermalLimit, IsThePeakWhereTheContinuousForceIsNotKnownOrNotLower) {
  for (const double continuous : {0.0, 7.9, 100.0, kInf}) {
    ThermalLimit thermal(7.9, continuous, 1);
    thermal.Heat(7.9, 1000);
    EXPECT_EQ(thermal.limit(), 7.9) << continuous;
  }
}

TEST(SafetyGate, KeepsTheMotorsCool) {
  SafetyGate gate = MakePressed(MakeSafetyLimits(device::DeviceProfile()), Vec3(0, 0, 5));
  EXPECT_EQ(gate.actions() & kGateThermal, kGateThermal);
  EXPECT_NEAR(PassFor(&gate, MakeInput(Vec3(0, 0, 5)), 5000), 1.75, 0.01);
}

// Half a second from nothing to everything, at 50 N/s at most.
TEST(SafetyGate, StartsSoftly) {
  const SafetyLimits limits = MakeColdLimits();
  SafetyGate gate(limits);
  double last = 0;
  for (int i = 1; i <= 500; ++i) {
    const double force = gate.Pass(MakeInput(Vec3(20, 0, 0))).f.norm();
    ASSERT_LE(force, limits.max_force * i / 500 + kRounding) << i;
    ASSERT_LE(force - last, limits.engage_force_rate * kDt + kRounding) << i;
    EXPECT_EQ(gate.actions() & (i < 500 ? kGateSoftStart : 0u), i < 500 ? kGateSoftStart : 0u);
    last = force;
  }
  EXPECT_NEAR(PassFor(&gate, MakeInput(Vec3(20, 0, 0)), 20), limits.max_force, 1e-9);
  EXPECT_EQ(gate.actions(), kGateMagnitude);
}

// A capture in the middle of a press: the force neither dips nor jumps, and grows slowly from
// there.
TEST(SafetyGate, CaptureIsForceContinuous) {
  const SafetyLimits limits = MakeColdLimits();
  SafetyGate gate = MakePressed(limits, Vec3(3, 0, 0));
  GateInput input = MakeInput(Vec3(3, 0, 0));
  input.has_engaged = true;
  EXPECT_EQ(gate.Pass(input).f, Vec3(3, 0, 0));
  EXPECT_EQ(PassFor(&gate, MakeInput(Vec3(3, 0, 0)), 50), 3);
  const double force = PassFor(&gate, MakeInput(Vec3(7, 0, 0)), 20);
  EXPECT_GT(force, 3);
  EXPECT_LE(force, 3 + 20 * limits.engage_force_rate * kDt);
  // Less is let through at once.
  EXPECT_NEAR(gate.Pass(MakeInput(Vec3(1, 0, 0))).f.x(), force - 0.4, kRounding);
}

// Each of these is zero within 5 ms, whatever is asked for, and comes back softly.
TEST(SafetyGate, CutsWithinFiveMilliseconds) {
  struct Case {
    GateAction action;
    void (*break_it)(GateInput*);
  };

  const Case cases[] = {
      {kGateNoDevice, [](GateInput* input) { input->is_valid = false; }},
      {kGateNoDevice, [](GateInput* input) { input->p.x() = kNan; }},
      {kGateNoDevice, [](GateInput* input) { input->V.w.z() = kInf; }},
      {kGateNotHeld, [](GateInput* input) { input->is_held = false; }},
      {kGateStopped, [](GateInput* input) { input->is_stopped = true; }},
  };
  for (const Case& c : cases) {
    SafetyGate gate = MakePressed(MakeColdLimits(), Vec3(0, 7, 0));
    GateInput input = MakeInput(Vec3(0, 7, 0));
    c.break_it(&input);
    for (int i = 1; i <= 5; ++i) {
      EXPECT_NEAR(gate.Pass(input).f.y(), 7 * (1 - 0.2 * i), 1e-9) << ToString(c.action);
      EXPECT_EQ(gate.actions() & c.action, c.action);
    }
    EXPECT_EQ(PassFor(&gate, input, 100), 0);
    EXPECT_LE(PassFor(&gate, MakeInput(Vec3(0, 7, 0)), 1), 0.05);
    EXPECT_EQ(gate.actions(), kGateSoftStart) << ToString(c.action);
    EXPECT_EQ(PassFor(&gate, MakeInput(Vec3(0, 7, 0)), 600), 7);
  }
}

// Up to 20 ms old a model is good, at 70 ms it gives nothing; the client is held for 2 ms.
TEST(SafetyGate, FadesWhenModelOrClientIsLate) {
  SafetyGate gate = MakePressed(MakeColdLimits(), Vec3(0, 5, 0));
  for (int age_ms = 0; age_ms < 100; ++age_ms) {
    GateInput input = MakeInput(Vec3(0, 5, 0));
    input.model_age = 1e-3 * age_ms;
    const double share = std::clamp(1 - (age_ms - 20) / 50.0, 0.0, 1.0);
    EXPECT_NEAR(gate.Pass(input).f.y(), 5 * share, 1e-9) << age_ms;
    EXPECT_EQ((gate.actions() & kGateLateModel) != 0, age_ms > 20) << age_ms;
  }
  gate = MakePressed(MakeColdLimits(), Vec3(0, 5, 0));
  for (int age_ms = 0; age_ms < 100; ++age_ms) {
    GateInput input = MakeInput(Vec3(0, 5, 0));
    input.client_age = 1e-3 * age_ms;
    const double share = std::clamp(1 - (age_ms - 2) / 50.0, 0.0, 1.0);
    EXPECT_NEAR(gate.Pass(input).f.y(), 5 * share, 1e-9) << age_ms;
  }
  GateInput input = MakeInput(Vec3(0, 5, 0));
  input.model_age = kNan;
  EXPECT_EQ(PassFor(&gate, input, 50), 0);
}

TEST(SafetyGate, FadesForAFastHandAndComesBack) {
  SafetyGate gate = MakePressed(MakeColdLimits(), Vec3(0, 5, 0));
  for (const double speed : {0.9, 1.1, 1.2, 3.0, 0.5}) {
    GateInput input = MakeInput(Vec3(0, 5, 0));
    input.V.v = Vec3(0.6 * speed, 0, 0.8 * speed);
    EXPECT_NEAR(PassFor(&gate, input, 50), 5 * std::clamp((1.2 - speed) / 0.2, 0.0, 1.0), 1e-9);
    EXPECT_EQ((gate.actions() & kGateSpeed) != 0, speed > 1);
  }
}

/** Limits that leave kicks to other tests. */
SafetyLimits MakeBuzzLimits() {
  SafetyLimits limits = MakeColdLimits();
  limits.kick.jerk = limits.kick.blow = kInf;
  return limits;
}

/** The hand swings at a frequency, and a spring's force with it, for a second. */
std::uint32_t Swing(double frequency_hz, double speed, double force) {
  SafetyGate gate = MakePressed(MakeBuzzLimits(), Vec3(2, 0, 0));
  std::uint32_t seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const double phase = 2 * M_PI * frequency_hz * i * kDt;
    GateInput input = MakeInput(Vec3(2 + force * std::sin(phase), 0, 0));
    input.V.v.x() = speed * std::cos(phase);
    (void)gate.Pass(input);
    seen |= gate.actions();
  }
  return seen & kGateBuzz;
}

TEST(SafetyGate, HearsBuzzingAndNoTremor) {
  for (const double frequency_hz : {25.0, 40.0, 60.0, 100.0}) {
    EXPECT_EQ(Swing(frequency_hz, 0.1, 0.5), kGateBuzz) << frequency_hz;
  }
  for (const double frequency_hz : {2.0, 5.0, 8.0, 10.0, 12.0}) {
    EXPECT_EQ(Swing(frequency_hz, 0.1, 0.5), 0u) << frequency_hz;
  }
  // Without a force, or too small to matter, it is the encoders.
  EXPECT_EQ(Swing(60, 0.1, 0.05), 0u);
  EXPECT_EQ(Swing(60, 0.01, 0.5), 0u);
}

TEST(SafetyGate, StaysCutAfterBuzzingUntilTheHandTakesAnew) {
  SafetyGate gate = MakePressed(MakeBuzzLimits(), Vec3(2, 0, 0));
  GateInput input = MakeInput(Vec3(2, 0, 0));
  for (int i = 0; !gate.is_latched(); ++i) {
    ASSERT_LT(i, 300);
    const double phase = 2 * M_PI * 40 * i * kDt;
    input.F.f.x() = 2 + std::sin(phase);
    input.V.v.x() = 0.1 * std::cos(phase);
    (void)gate.Pass(input);
  }
  EXPECT_EQ(gate.actions() & kGateBuzz, kGateBuzz);
  input = MakeInput(Vec3(2, 0, 0));
  (void)PassFor(&gate, input, 5);
  EXPECT_EQ(PassFor(&gate, input, 1000), 0);
  input.is_gripping = false;
  EXPECT_EQ(PassFor(&gate, input, 1000), 0);
  EXPECT_TRUE(gate.is_latched());
  input.is_gripping = true;
  EXPECT_EQ(PassFor(&gate, input, 600), 2);
  EXPECT_FALSE(gate.is_latched());
}

TEST(SafetyGate, TellsEachActionOnceWithItsReason) {
  std::uint32_t before = kGatePassed;
  int count = 0;
  for (const GateAction action : kGateActions) {
    EXPECT_STRNE(ToString(action), "unknown");
    EXPECT_LT(action, 1u << 16);  // Records keep other bits above.
    const GateActionList list = ListNewActions(before, before | action);
    ASSERT_EQ(list.count, 1u);
    EXPECT_EQ(*list.begin(), action);
    before |= action;
    ++count;
  }
  EXPECT_EQ(ListNewActions(before, before).count, 0u);
  EXPECT_EQ(ListNewActions(0, before).count, static_cast<std::size_t>(count));
  EXPECT_EQ(ListNewActions(before, 0).count, 0u);
}

/** What happens in a stretch of time. */
enum class Stretch {
  kRest,  ///< Nothing disturbs the work, and the hand rests but for its velocity: it buzzes.
  kWork,  ///< Nothing disturbs the work.
  kWild,
};

GateInput DrawInput(Stretch stretch, Random* random) {
  const bool is_resting = stretch == Stretch::kRest;
  const bool is_wild = stretch == Stretch::kWild;
  GateInput input;
  const auto is = [&](double share) { return random->Uniform() < share; };
  const bool is_calm = is(0.7);
  for (int k = 0; k < 3; ++k) {
    input.F.f[k] = is_calm ? random->Uniform(-3, 3) : DrawAny(random);
    input.F.t[k] = is_calm ? random->Uniform(-0.1, 0.1) : DrawAny(random);
    if (!is_resting) {
      input.p[k] = !is_wild || is(0.98) ? random->Uniform(-1e-4, 1e-4) : DrawAny(random);
    }
    const bool is_usual = !is_wild || is(0.98);
    input.V.v[k] = is_usual ? random->Uniform(-0.1, 0.1) : DrawAny(random);
    input.V.w[k] = is_usual ? random->Uniform(-0.1, 0.1) : DrawAny(random);
  }
  input.dt = is(0.95) ? kDt : DrawTime(random);
  input.is_gripping = is(0.8);
  if (is_wild) {
    input.is_valid = is(0.99);
    input.is_held = is(0.99);
    input.is_stopped = is(0.01);
    input.has_engaged = is(0.01);
    input.model_age = is(0.97) ? 0 : std::abs(DrawAny(random)) * 1e-2;
    input.client_age = is(0.97) ? 0 : DrawAny(random) * 1e-2;
    input.since_write_ns = is(0.99) ? 1'000'000 : static_cast<std::int64_t>(random->NextBits());
  }
  return input;
}

/** What the gate did in random ticks, in which it kept its promises. */
struct RandomTicks {
  std::uint32_t seen{0};  ///< Actions.
  int cuts{0};
};

void RunRandomTicks(const SafetyLimits& limits, RandomTicks* ran) {
  Random random(11);
  SafetyGate gate(limits);
  constexpr std::uint32_t kCuts =
      kGateNoDevice | kGateNotHeld | kGateStopped | kGateBuzz | kGateKick;
  Wrench last;
  for (int i = 0; i < 100'000; ++i) {
    const GateInput input = DrawInput(static_cast<Stretch>(i / 1000 % 3), &random);
    const bool has_time = input.dt > 0 && std::isfinite(input.dt);
    const double time =
        has_time ? std::min(input.dt, 2e-3) : 0;  // A late write counts for so much.
    const Wrench out = gate.Pass(input);
    if ((gate.actions() & kGateStalled) != 0) {
      last = {};
    }
    ASSERT_TRUE(out.f.allFinite() && out.t.allFinite()) << i;
    ASSERT_LE(out.f.norm(), limits.max_force * (1 + kRounding)) << i;
    ASSERT_LE(out.t.norm(), limits.max_torque * (1 + kRounding)) << i;
    const double step = (out.f - last.f).norm();
    const double turn_step = (out.t - last.t).norm();
    if ((gate.actions() & kCuts) != 0) {
      ++ran->cuts;
      ASSERT_LE(out.f.norm(), last.f.norm() + kRounding) << i;
      ASSERT_LE(out.t.norm(), last.t.norm() + kRounding) << i;
    } else {
      ASSERT_LE(step, limits.max_force_rate * time * (1 + 1e-9) + kRounding) << i;
      ASSERT_LE(turn_step, limits.max_torque_rate * time * (1 + 1e-9) + kRounding) << i;
    }
    last = out;
    ran->seen |= gate.actions();
  }
}

// N6, with everything on: finite and within its norm always; within its slew but where the force is
// cut, and then towards zero.
TEST(SafetyGate, KeepsItsPromisesOverRandomTicksOfARealDevice) {
  RandomTicks ran;
  RunRandomTicks(MakeSafetyLimits(device::DeviceProfile()), &ran);
  EXPECT_GT(ran.cuts, 1000);
  EXPECT_LT(ran.cuts, 90'000);
  RunRandomTicks(MakeColdLimits(), &ran);  // Warm motors are limited to less than their peak.
  for (const GateAction action : kGateActions) {
    EXPECT_EQ(ran.seen & action, action) << ToString(action);
  }
}

}  // namespace
}  // namespace hvas::haptics
