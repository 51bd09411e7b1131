// A thread in a scripted hand: its pitch, play, torques of VDI 2230-1, entry, crossing, energy.

#include "haptics/thread_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "fits/threads.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::kDt;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kEngaged = 6.5e-3;  // Engaged in its place.

HeldThread MakeM8(double stiffness) {
  const fits::Thread& m8 = *fits::FindThread(8e-3, 0);
  HeldThread thread;
  thread.lead = m8.pitch;
  thread.play = fits::CalcMeanFlankPlay(m8);
  thread.pitch_diameter = m8.pitch_diameter();
  thread.friction = 0.12;
  thread.head_radius = 0.5 * 10.3e-3;
  thread.stiffness = stiffness;
  thread.preload = stiffness > 0 ? fits::CalcTightening(m8, 640e6, 0.12, 0.12, 10.3e-3).preload : 0;
  return thread;
}

/** A nut on a bolt along z, in no one's hand, pushed and turned. Its place is at z = 0. */
struct NutOnBolt {
  explicit NutOnBolt(const HeldThread& thread, double start, double turned = 0)
      : rows(MakeTorqueMap(device)) {
    part.mass = 0.3;
    mate.capture = {product::MateKind::kAxisHole, -50e-3, kEngaged, 0, 50e-3, 0};
    mate.radius = 4e-3;
    mate.thread = thread;
    part.mates = {mate};
    displayed.part = &part;
    displayed.X_WD = Pose(spatial::RotationFromVector(Vec3(0, 0, turned)), Vec3(0, 0, start));
    rows.Reset(false);
  }

  /** A step with a force down its axis and a torque clockwise seen from above, so in. */
  ThreadForces Step(double push, double torque) {
    solver.Begin(part.mass, kInertia * Mat3::Identity(), displayed.p_WCm(), displayed.V, kDt);
    solver.AddWrench({Vec3(0, 0, -torque), Vec3(0, 0, -push)});
    // What guides it and the hand's own damping.
    const Vec3 axis = Vec3::UnitZ();
    solver.AddPointSpring(displayed.p_WCm(), Vec3::Zero(),
                          1e6 * (Mat3::Identity() - axis * axis.transpose()));
    solver.AddAngularDamper(Vec3::Zero(), damping);
    solver.AddPointDamper(displayed.p_WCm(), Vec3::Zero(), 1000 * damping);
    geometry = CalcMateGeometry(part.mates[0], displayed.X_WD);
    rows.Add(displayed, part.mates[0], geometry, contact, kDt, &solver);
    displayed.V = solver.Solve(60);
    angle += kDt * displayed.V.w.z();
    displayed.X_WD = {spatial::RotationFromVector(kDt * displayed.V.w) * displayed.X_WD.q(),
                      displayed.X_WD.p() + kDt * displayed.V.v};
    return rows.Finish(solver);
  }

  [[nodiscard]] double z() const { return displayed.X_WD.p().z(); }

  static constexpr double kInertia = 1e-4;
  double damping{2e-3};
  double angle{0};  // Turned in all.
  device::DeviceProfile device;
  ContactOptions contact;
  HeldMate mate;
  HeldPart part;
  DisplayedPart displayed;
  MateGeometry geometry;
  ThreadRows rows;
  ConstraintSolver solver;
};

TEST(ThreadRows, ANutGoesDownByItsPitch) {
  for (const double lead_sign : {1.0, -1.0}) {
    HeldThread thread = MakeM8(0);
    thread.lead *= lead_sign;
    NutOnBolt nut(thread, kEngaged + 1e-3);
    // It drops until its first flank holds it.
    for (int i = 0; i < 2000; ++i) {
      (void)nut.Step(2, 0);
    }
    ASSERT_TRUE(nut.rows.is_in());
    const double z_start = nut.z();
    ASSERT_GT(z_start, kEngaged - std::abs(thread.lead));
    const double angle_start = nut.angle;
    while (nut.z() > 0.5e-3 && nut.angle * lead_sign > -50) {
      (void)nut.Step(2, 0.02 * lead_sign);
    }
    const double turned = (angle_start - nut.angle) * lead_sign;
    const double advance = (z_start - nut.z()) / turned * kTurn;
    EXPECT_NEAR(advance / std::abs(thread.lead), 1, 0.005);
    // And up again, pulled: after its play, by its pitch.
    while (nut.z() < 2e-3) {
      (void)nut.Step(-2, -0.02 * lead_sign);
    }
    const double z_low = nut.z();
    const double angle_low = nut.angle;
    while (nut.z() < 4e-3) {
      (void)nut.Step(-2, -0.02 * lead_sign);
    }
    EXPECT_NEAR((nut.z() - z_low) / (nut.angle - angle_low) * lead_sign * kTurn,
                std::abs(thread.lead), 0.005 * std::abs(thread.lead));
    // Turned further it comes out, and falls to the mouth no more.
    for (int i = 0; i < 60000 && nut.rows.is_in(); ++i) {
      (void)nut.Step(-2, -0.02 * lead_sign);
    }
    EXPECT_FALSE(nut.rows.is_in());
    EXPECT_GT(nut.z(), kEngaged);
  }
}

// Neither pushed nor pulled a nut moves by more than its play, as its thread locks itself.
TEST(ThreadRows, HoldsAgainstForceWithItsPlay) {
  NutOnBolt nut(MakeM8(0), 3e-3);
  double low = 1;
  double high = -1;
  for (int cycle = 0; cycle < 2; ++cycle) {
    for (const double push : {20.0, -20.0}) {
      for (int i = 0; i < 3000; ++i) {
        (void)nut.Step(push, 0);
      }
      low = std::min(low, nut.z());
      high = std::max(high, nut.z());
    }
  }
  const double given = 2 * 20 * nut.contact.compliance;
  EXPECT_NEAR(high - low, MakeM8(0).play + given, 2e-6);
  EXPECT_NEAR(nut.angle, 0, 2e-3);
}

// What a loaded thread resists turning with: down F (1.155 mu d2 / 2 + P / (2 pi)), up without the
// pitch's part taken away.
TEST(ThreadRows, TurnsUnderLoadByThePublishedTorque) {
  const HeldThread thread = MakeM8(0);
  const double push = 10;
  const double flank = 1.155 * thread.friction * 0.5 * thread.pitch_diameter;
  const double rise = thread.lead / kTurn;
  for (const double sense : {1.0, -1.0}) {  // Against the push upwards, along it downwards.
    const double expected = push * (flank - sense * rise);
    for (const double share : {0.97, 1.03}) {
      NutOnBolt nut(thread, 3e-3);
      for (int i = 0; i < 1000; ++i) {
        (void)nut.Step(push, 0);
      }
      const double before = nut.angle;
      for (int i = 0; i < 3000 && nut.z() > 1e-3 && nut.z() < 5e-3; ++i) {
        (void)nut.Step(push, sense * share * expected);
      }
      const double turned = std::abs(nut.angle - before);
      EXPECT_EQ(turned > 0.05, share > 1) << sense << " " << share << " " << turned;
    }
  }
}

// Tightened to its preload it takes VDI 2230-1's torque; what loosens it is less by twice the
// pitch's part.
TEST(ThreadRows, TightensAndBreaksLooseByThePublishedTorque) {
  const fits::Thread& m8 = *fits::FindThread(8e-3, 0);
  const fits::Tightening tightening = fits::CalcTightening(m8, 640e6, 0.12, 0.12, 10.3e-3);
  const double stiffness = fits::CalcJointStiffness(m8, 20e-3);
  NutOnBolt nut(MakeM8(stiffness), 0);
  const double turn_to_preload = tightening.preload / (stiffness * m8.pitch / kTurn);
  nut.displayed.X_WD = Pose(spatial::RotationFromVector(Vec3(0, 0, turn_to_preload)), Vec3::Zero());
  // The hand turns it slowly; what resists is read where it is.
  ThreadForces forces;
  double worst = 0;
  double pull = 0;
  double most_preload = 0;
  for (int i = 0; i < 40000 && most_preload < tightening.preload; ++i) {
    pull += 1e-4;
    forces = nut.Step(1, pull);
    most_preload = std::max(most_preload, forces.preload);
    if (forces.preload > 500 && -nut.displayed.V.w.z() > 1e-3) {
      const double expected =
          forces.preload * (m8.pitch / kTurn + 0.58 * m8.pitch_diameter() * 0.12 + 0.12 * 5.15e-3);
      worst = std::max(worst, std::abs(forces.torque_true / expected - 1));
    }
  }
  EXPECT_GE(most_preload, tightening.preload);
  EXPECT_LT(worst, 0.01);
  EXPECT_NEAR(forces.torque_true / tightening.torque, 1, 0.02);
  // It keeps its preload when it is let go, and gives it back turned loose.
  for (int i = 0; i < 2000; ++i) {
    forces = nut.Step(0, 0);
  }
  EXPECT_NEAR(forces.preload / most_preload, 1, 0.02);
  const double held = forces.preload;
  pull = 0;
  double loosening = 0;
  const double angle_tight = nut.angle;
  for (int i = 0; i < 100000 && nut.angle < angle_tight + 0.01; ++i) {
    pull -= 1e-4;
    forces = nut.Step(0, pull);
    loosening = std::min(loosening, forces.torque_true);
  }
  const double expected =
      held * (0.58 * m8.pitch_diameter() * 0.12 + 0.12 * 5.15e-3 - m8.pitch / kTurn);
  EXPECT_NEAR(-loosening / expected, 1, 0.03);
}

// Pressed on and turned backwards, it rises on the first turn and drops by a pitch where the thread
// begins; forwards it catches there.
TEST(ThreadRows, ClicksWhenTurnedBackwardsAtTheMouth) {
  NutOnBolt nut(MakeM8(0), kEngaged + 0.2e-3, 1.0);
  for (int i = 0; i < 1000; ++i) {
    (void)nut.Step(2, 0);
  }
  int drops = 0;
  double highest = nut.z();
  const double start = nut.angle;
  while (nut.angle < start + 3 * kTurn) {
    (void)nut.Step(2, -0.03);
    if (nut.z() > highest) {
      highest = nut.z();
    } else if (nut.z() < highest - 0.7 * nut.mate.thread->lead) {
      ++drops;
      highest = nut.z();
    }
  }
  EXPECT_EQ(drops, 3);
  EXPECT_GT(nut.z(), kEngaged - nut.mate.thread->lead - 1e-5);
}

TEST(ThreadRows, IsCrossedWhereItComesInTilted) {
  const HeldThread thread = MakeM8(0);
  const double limit = std::atan(0.5 * thread.lead / thread.pitch_diameter);
  for (const double share : {0.9, 1.1}) {
    NutOnBolt nut(thread, kEngaged - 1e-6);
    nut.displayed.X_WD =
        Pose(spatial::RotationFromVector(Vec3(share * limit, 0, 0)), nut.displayed.X_WD.p());
    (void)nut.Step(2, 0);
    ASSERT_TRUE(nut.rows.is_in());
    EXPECT_EQ(nut.rows.is_crossed(), share > 1);
    nut.displayed.X_WD = Pose(Quat::Identity(), nut.displayed.X_WD.p());
    nut.displayed.V = {};
    nut.angle = 0;
    for (int i = 0; i < 20000 && nut.angle > -3 * kTurn; ++i) {
      (void)nut.Step(2, 0.05);
    }
    EXPECT_EQ(nut.angle < -2 * kTurn, share < 1) << nut.angle;
    if (share > 1) {
      // Turned back it comes out, and may be tried anew.
      for (int i = 0; i < 20000 && nut.rows.is_in(); ++i) {
        (void)nut.Step(-1, -0.05);
      }
      EXPECT_FALSE(nut.rows.is_crossed());
    }
  }
}

// L: energy out never exceeds energy in over a million ticks of random handling.
TEST(ThreadRows, NeverGiveMoreEnergyThanTheyTook) {
  const fits::Thread& m8 = *fits::FindThread(8e-3, 0);
  HeldThread thread = MakeM8(fits::CalcJointStiffness(m8, 20e-3));
  NutOnBolt nut(thread, kEngaged + 1e-3);
  nut.damping = 0;
  Random random(11);
  double given = 0;
  double most = -1;
  double push = 0;
  double torque = 0;
  int inside = 0;
  int tight = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    if (i % 200 == 0) {
      push = nut.z() > kEngaged + 2e-3 ? 3 : random.Uniform(-4, 6);
      torque = random.Uniform(-0.08, 0.1) * (random.Uniform(0, 1) < 0.3 ? 3 : 1);
    }
    const spatial::Twist before = nut.displayed.V;
    const ThreadForces forces = nut.Step(push, torque);
    // Work of what drives it at the mean speed of the tick, as the energy of a body has it.
    const Vec3 v = 0.5 * (before.v + nut.displayed.V.v);
    const Vec3 w = 0.5 * (before.w + nut.displayed.V.w);
    given += kDt * (-push * v.z() - torque * w.z());
    const double kinetic = 0.5 * nut.part.mass * nut.displayed.V.v.squaredNorm() +
                           0.5 * NutOnBolt::kInertia * nut.displayed.V.w.squaredNorm();
    most = std::max(most, kinetic - given);
    inside += nut.rows.is_in() ? 1 : 0;
    tight += forces.preload > 0 ? 1 : 0;
    ASSERT_TRUE(nut.displayed.V.v.allFinite());
  }
  RecordProperty("most_given_uj", std::to_string(1e6 * most));
  EXPECT_GT(inside, 300'000);
  EXPECT_GT(tight, 1000);
  EXPECT_LT(most, 1e-6);
}

}  // namespace
}  // namespace hvas::haptics
