// Gains from a device's limits: stable where a wall of them is rendered, X4 and N6.

#include "haptics/coupling_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/passivity_controller.h"
#include "haptics/safety_gate.h"
#include "haptics/test/values.h"

namespace hvas::haptics {
namespace {

using device::DeviceProfile;
using testing::kDt;

static_assert(noexcept(ChooseCoupling(std::declval<const DeviceProfile&>(), 1, 1e-3)));

constexpr double kGrip = 5;  // [N s/m]; the least damping of a hand that the rule counts on

// A device of which one limit binds at a time, by hand.
TEST(CouplingRule, TakesTheLowestOfItsLimits) {
  DeviceProfile profile;
  profile.rate_hz = 1 / kDt;
  profile.damping = 1;
  profile.delay = 1.5e-3;  // So that T/2 + t_d is 2 ms.
  profile.max_stiffness = 1000;
  profile.max_damping = 4;
  profile.friction = 1;
  profile.position_resolution = 1e-5;
  CouplingGains gains = ChooseCoupling(profile, 1, kDt);
  EXPECT_NEAR(gains.k_lin, 500, 1e-9);  // half of the maker's
  EXPECT_NEAR(gains.b_lin, 2, 1e-9);
  profile.max_stiffness = 1e5;
  profile.max_damping = 100;
  gains = ChooseCoupling(profile, 1, kDt);
  EXPECT_NEAR(gains.k_lin, 0.5 * 6 / 2e-3, 1e-9);  // sampling and delay
  EXPECT_NEAR(gains.b_lin, 3, 1e-9);               // what these leave of the damping
  profile.position_resolution = 2e-3;
  gains = ChooseCoupling(profile, 1, kDt);
  EXPECT_NEAR(gains.k_lin, 2 * 1 / 2e-3, 1e-9);  // the encoders' steps
  EXPECT_NEAR(gains.b_lin, 6 - 2, 1e-9);
  // Slower samples count as a longer tick.
  profile.rate_hz = 100;
  gains = ChooseCoupling(profile, 1, kDt);
  EXPECT_NEAR(gains.k_lin, 0.5 * 6 / 6.5e-3, 1e-9);
}

// Forces are not scaled: where a millimetre of the hand is five of the scene, so are five times
// less newtons per metre of the scene.
TEST(CouplingRule, ShowsTheDeviceTheSameWallAtAnyScale) {
  for (const auto& known : device::KnownProfiles()) {
    const CouplingGains one = ChooseCoupling(known.profile, 1, kDt);
    const CouplingGains five = ChooseCoupling(known.profile, 5, kDt);
    const double factor = known.profile.max_force > 0 ? 5 : 1;
    EXPECT_NEAR(factor * five.k_lin, one.k_lin, 1e-9) << known.profile.id;
    EXPECT_NEAR(factor * five.b_lin, one.b_lin, 1e-9) << known.profile.id;
    EXPECT_EQ(five.k_rot, one.k_rot);
    EXPECT_EQ(five.b_rot, one.b_rot);
  }
}

// Colgate's b > K T / 2 + |B|, with the delay added, holds for every profile; and every gain drags
// a part.
TEST(CouplingRule, IsPassiveForEveryProfileByColgatesCondition) {
  for (const auto& known : device::KnownProfiles()) {
    const DeviceProfile& profile = known.profile;
    for (const double dt : {1.25e-4, 2.5e-4, kDt, 2e-3}) {
      const CouplingGains gains = ChooseCoupling(profile, 1, dt);
      EXPECT_GT(gains.k_lin, 0) << profile.id;
      EXPECT_GT(gains.k_rot, 0) << profile.id;
      if (profile.max_force <= 0) {
        EXPECT_EQ(gains.k_lin, CouplingGains().k_lin) << profile.id;
        continue;
      }
      const double late = 0.5 * std::max(dt, 1 / profile.rate_hz) + profile.delay;
      EXPECT_GE(profile.damping + kGrip, gains.k_lin * late + gains.b_lin - 1e-9) << profile.id;
      EXPECT_LE(gains.k_lin, 0.5 * profile.max_stiffness) << profile.id;
      EXPECT_LE(gains.b_lin, 0.5 * profile.max_damping) << profile.id;
    }
  }
}

// Devices at all ends of what CheckProfile lets in: whatever they claim, all that is derived from
// it is a number, and the gate lets through no more than the claim.
TEST(CouplingRule, EveryProfileThatIsLetInGivesFiniteGains) {
  using P = DeviceProfile;
  constexpr std::array kFigures{&P::max_force,
                                &P::continuous_force,
                                &P::max_torque,
                                &P::continuous_torque,
                                &P::max_stiffness,
                                &P::max_damping,
                                &P::max_rotational_stiffness,
                                &P::max_rotational_damping,
                                &P::position_resolution,
                                &P::rotation_resolution,
                                &P::rate_hz,
                                &P::mass,
                                &P::damping,
                                &P::rotational_damping,
                                &P::friction,
                                &P::rotational_friction,
                                &P::delay};
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    P profile;
    for (double P::*figure : kFigures) {
      const double before = profile.*figure;
      profile.*figure =
          i % 3 == 0 && random.NextBits() % 4 == 0 ? 0 : std::pow(10, random.Uniform(-11, 7));
      if (!device::CheckProfile(profile, "a device")) {
        profile.*figure = before;
      }
    }
    for (const double dt : {1.25e-4, kDt}) {
      const CouplingGains gains = ChooseCoupling(profile, 1, dt);
      for (const double gain : {gains.k_lin, gains.b_lin, gains.k_rot, gains.b_rot}) {
        ASSERT_TRUE(std::isfinite(gain)) << i;
      }
      PassivityController controller = MakePassivityController(profile, dt);
      SafetyGate gate(MakeSafetyLimits(profile));
      for (int k = 0; k < 50; ++k) {
        GateInput input;
        input.dt = dt;
        input.F = controller.Limit(spatial::Pose(Vec3(1e-5 * k, 0, 0)),
                                   {Vec3(0, 1e3, 0), Vec3(gains.k_lin, 1e5, 0)}, 0, 0, dt);
        const spatial::Wrench out = gate.Pass(input);
        ASSERT_TRUE(out.f.allFinite() && out.t.allFinite()) << i;
        ASSERT_LE(out.f.norm(), profile.max_force * (1 + 1e-12)) << i;
        ASSERT_LE(out.t.norm(), profile.max_torque * (1 + 1e-12)) << i;
        controller.Write(out);
      }
    }
  }
}

// A device without torque still turns the part that it holds: the coupling's turning gains are
// those of the simulated device.
TEST(CouplingRule, DragsThePartRoundWhereNoTorqueIsShown) {
  const CouplingGains gains = ChooseCoupling(device::FindProfile("touch")->profile, 1, kDt);
  EXPECT_EQ(gains.k_rot, CouplingGains().k_rot);
  EXPECT_EQ(gains.b_rot, CouplingGains().b_rot);
  const CouplingGains shown = ChooseCoupling(device::FindProfile("sigma7")->profile, 1, kDt);
  EXPECT_LT(shown.k_rot, CouplingGains().k_rot);
}

}  // namespace
}  // namespace hvas::haptics
