// The last thing before the device: N6. Fail-safe on missing or broken data.

#include "haptics/safety_gate.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::haptics {
namespace {

using spatial::Wrench;

constexpr double kDt = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
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

}  // namespace
}  // namespace hvas::haptics
