// A device that pushes the wrong way loses its force; a hand that works does not. N6.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/coupling_rule.h"
#include "haptics/kick_detector.h"
#include "haptics/test/values.h"
#include "haptics/test/wall_rig.h"

namespace hvas::haptics {
namespace {

using device::DeviceProfile;
using device::Fault;
using testing::CalcReach;
using testing::Grip;
using testing::kGrips;
using testing::kProfiles;
using testing::MakeHand;
using testing::SetTarget;
using testing::WallRig;

/** Limits of a real device, with motors that stand anything: so that presses stay hard. */
SafetyLimits MakeColdLimits(const DeviceProfile& profile) {
  SafetyLimits limits = MakeSafetyLimits(profile);
  limits.continuous_force = SafetyLimits::kNever;
  return limits;
}

/** A device, a hand and a wall with the chosen gains, by a seed. */
struct Scene {
  explicit Scene(std::uint64_t seed)
      : random(seed),
        profile(device::FindProfile(kProfiles[seed % std::size(kProfiles)])->profile),
        grip(kGrips[(seed / std::size(kProfiles)) % std::size(kGrips)]),
        dt(1 / profile.rate_hz),
        gains(ChooseCoupling(profile, 1, dt)),
        press(random.Uniform(0.15, 0.6) * std::min(profile.max_force, 8.0)) {}

  [[nodiscard]] double depth() const {
    return std::min(0.03, press / grip.stiffness + press / gains.k_lin);
  }

  Random random;
  DeviceProfile profile;
  Grip grip;
  double dt;
  CouplingGains gains;
  double press;  ///< That the hand presses with [N].
};

struct FlipResult {
  double shows{-1};    ///< From the flip until the handle is elsewhere than without it [s].
  double latency{-1};  ///< From then until the force decays [s]; -1: never.
  double left{0};      ///< Force 5 ms after the latch [N].
  double force{0};     ///< Before the flip [N].
  double strayed{0};   ///< How far the handle went in all [m].
};

FlipResult Flip(std::uint64_t seed) {
  Scene scene(seed);
  WallRig rig(scene.profile, scene.gains.k_lin, scene.gains.b_lin);
  WallRig twin(scene.profile, scene.gains.k_lin, scene.gains.b_lin);
  SafetyGate gate(MakeColdLimits(scene.profile));
  SafetyGate twin_gate(MakeColdLimits(scene.profile));
  rig.gate = &gate;
  twin.gate = &twin_gate;
  rig.delay = twin.delay = testing::CountDelay(scene.profile, scene.dt);
  device::HandIntent hand = MakeHand(scene.grip);
  const double flip_time = scene.random.Uniform(1.0, 1.3);
  const double visible = std::max(50e-6, 3 * scene.profile.position_resolution);
  FlipResult result;
  double latched = -1;
  for (double t = 0; t < flip_time + 0.3; t += scene.dt) {
    SetTarget(CalcReach(-0.01, scene.depth(), 0.4, t - 0.5), &hand);
    if (t >= flip_time && rig.device.fault() == Fault::kNone) {
      EXPECT_FALSE(gate.is_latched());
      rig.device.SetFault(Fault::kSignFlipped);
    }
    rig.Tick(hand, scene.dt);
    twin.Tick(hand, scene.dt);
    const double apart = (rig.device.truth().X_DH.p() - twin.device.truth().X_DH.p()).norm();
    if (result.shows < 0 && apart > visible) {
      result.shows = t - flip_time;
    }
    if (latched < 0 && gate.is_latched()) {
      latched = t;
    }
    if (latched >= 0 && t <= latched + 5.01e-3) {
      result.left = rig.written.norm();
    }
  }
  if (latched >= 0 && result.shows >= 0) {
    result.latency = std::max(0.0, latched - flip_time - result.shows);
  }
  return result;
}

// From the moment at which the handle is three encoder steps from where it would be. A firm hand on
// a coarse device hardly moves when the sign flips, which nothing tells from a hand that presses
// harder: of these some stay unnoticed, and their force stays bounded by the wall's.
TEST(Kick, ADeviceWithItsSignFlippedLosesItsForceWithinMilliseconds) {
  constexpr int kRuns = 200;
  int shown = 0;
  int caught = 0;
  int in_time = 0;
  int light = 0;
  int light_caught = 0;
  double longest = 0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const FlipResult result = Flip(seed);
    if (result.shows < 0) {
      continue;
    }
    const bool is_light = Scene(seed).grip.mass < 0.5;
    const bool is_caught = result.latency >= 0;
    ++shown;
    caught += is_caught ? 1 : 0;
    in_time += is_caught && result.latency <= 5e-3 ? 1 : 0;
    light += is_light ? 1 : 0;
    light_caught += is_light && is_caught ? 1 : 0;
    longest = std::max(longest, result.latency);
    if (is_caught) {
      EXPECT_NEAR(result.left, 0, 1e-9) << seed;
    }
  }
  RecordProperty("shown", shown);
  RecordProperty("caught", caught);
  RecordProperty("in_5_ms", in_time);
  RecordProperty("light", light);
  RecordProperty("light_caught", light_caught);
  RecordProperty("longest_us", static_cast<int>(1e6 * longest));
  EXPECT_EQ(shown, kRuns);
  EXPECT_GE(caught, 0.7 * shown);
  EXPECT_GE(light_caught, 0.95 * light);
  EXPECT_GE(in_time, 0.98 * caught);
  EXPECT_LE(longest, 10e-3);
}

enum class Work { kPress, kTap, kLetGo, kSlide };

/** Whether anything latched in 4 s of work. */
std::uint32_t Do(std::uint64_t seed, Work work) {
  Scene scene(seed);
  WallRig rig(scene.profile, scene.gains.k_lin, scene.gains.b_lin);
  SafetyGate gate(MakeColdLimits(scene.profile));
  rig.gate = &gate;
  rig.delay = testing::CountDelay(scene.profile, scene.dt);
  device::HandIntent hand = MakeHand(scene.grip);
  const double tremor_hz = scene.random.Uniform(8, 12);
  const double tremor = scene.random.Uniform(0.05e-3, 0.3e-3);
  const double beat = scene.random.Uniform(0.2, 0.5);  // 2 to 5 taps a second
  const double fast = scene.random.Uniform(0.15, 0.4);
  const double let_go = scene.random.Uniform(1.5, 2.5);
  std::uint32_t seen = 0;
  for (double t = 0; t < 4; t += scene.dt) {
    testing::Reach reach = CalcReach(-0.01, scene.depth(), fast, t - 0.6);
    if (work == Work::kTap && t > 0.6) {
      const double phase = std::fmod(t, beat);
      reach = phase < beat / 2 ? CalcReach(-5e-3, scene.depth(), beat / 2, phase)
                               : CalcReach(scene.depth(), -5e-3, beat / 2, phase - beat / 2);
    }
    if (work == Work::kPress && t > 2.5) {
      reach = CalcReach(scene.depth(), -0.01, fast, t - 2.5);
    }
    reach.p += tremor * std::sin(2 * M_PI * tremor_hz * t);
    SetTarget(reach, &hand);
    if (work == Work::kSlide) {
      hand.X_DR = spatial::Pose(Vec3(reach.p, 0.03 * std::sin(4 * t), 0));
    }
    if (work == Work::kLetGo && t > let_go) {
      rig.TickWithoutHand(scene.dt);
    } else {
      rig.Tick(hand, scene.dt);
    }
    seen |= gate.actions() & (kGateKick | kGateBuzz);
  }
  return seen;
}

TEST(Kick, OrdinaryWorkRaisesNoAlarm) {
  for (const Work work : {Work::kPress, Work::kTap, Work::kLetGo, Work::kSlide}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      EXPECT_EQ(Do(seed, work), 0u) << static_cast<int>(work) << ", seed " << seed;
    }
  }
}

// A machine that pauses samples late; of what the hand did meanwhile, nothing is known.
TEST(Kick, HandThatWorksWhileSamplesPauseRaisesNoAlarm) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    KickDetector detector({});
    const double reach = random.Uniform(5e-3, 0.03);
    const double hz = random.Uniform(0.5, 1.5);
    int alarms = 0;
    double dt = 1e-3;
    for (double t = 0; t < 20; t += dt) {
      const Vec3 p(reach * std::sin(2 * M_PI * hz * t), 0, 0);
      alarms += detector.Update(p, Vec3(1, 0, 0), dt) != Kick::kNone ? 1 : 0;
      dt = random.Uniform(0, 1) < 0.02 ? random.Uniform(5e-3, 0.1) : 1e-3;
    }
    EXPECT_EQ(alarms, 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace hvas::haptics
