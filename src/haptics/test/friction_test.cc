// Dry friction with stick and slip: X11, W5.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "haptics/friction_memory.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using contact::testing::Block;
using contact::testing::Build;
using spatial::Pose;
using spatial::Twist;
using testing::BlockRig;
using testing::kDt;

constexpr double kLoad = 10;  // [N]

/** The bristle by 10,000 steps of Euler's method. */
double CalcBristle(double z, double v, double z_max, double time) {
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double slip = std::abs(z + v * time / kSteps) > z_max ? std::abs(v) * z / z_max : 0;
    z += time / kSteps * (v - slip);
  }
  return z;
}

// Exact however far it is dragged in a step, where Euler's method is stable only up to
// |v| < 2 z_max / dt: 3.6 mm/s here.
TEST(BendBristle, AgreesWithFineStepsAtAnySpeed) {
  const double z_max = 1.8e-6;
  for (const double v : {-1.0, -3e-3, -1e-3, 1e-4, 2e-3, 0.1, 1.0}) {
    for (const double z : {-1.8e-6, -1e-6, 0.0, 1.7e-6}) {
      // From where it begins to slide: before that it only bends.
      const double start = std::abs(z + v * kDt) > z_max ? z : 0;
      const Vec3 bent = BendBristle(Vec3(start, 0, 0), Vec3(v, 0, 0), z_max, kDt);
      EXPECT_LE(bent.norm(), z_max * (1 + 1e-12));
      if (std::abs(start + v * kDt) <= z_max) {
        EXPECT_NEAR(bent.x(), start + v * kDt, 1e-18);
      } else {
        const double end = std::copysign(z_max, v);
        EXPECT_NEAR(bent.x(), end + (start - end) * std::exp(-std::abs(v) * kDt / z_max), 1e-18);
      }
    }
  }
  // A slide from the end of the one side to the other is LuGre's throughout.
  EXPECT_NEAR(BendBristle(Vec3(-z_max, 0, 0), Vec3(-2e-3, 0, 0), z_max, kDt).x(),
              CalcBristle(-z_max, -2e-3, z_max, kDt), 1e-9);
}

/** A block of 1 kg on a plane under 10 N, pulled along x by a force or led at a speed. */
struct Slider {
  fits::FrictionLaw law{0.3, 0.2, 5e-3, 0, 1e6};
  ConstraintSolver solver;
  FrictionMemory memory;
  Vec3 p{0, 0, 0};  // Pulled in the plane of its contacts: nothing tilts.
  Twist V;
  double force{0};  // Of friction, along x.

  void Step(double pull, double lead_speed = 0, double lead = 0) {
    memory.BeginTick();
    solver.Begin(1, 1e-3 * Mat3::Identity(), p, V, kDt);
    solver.AddWrench({Vec3::Zero(), Vec3(pull, 0, -kLoad)});
    solver.AddPointDamper(p, Vec3(lead_speed, 0, 0), lead);
    solver.AddAngularSpring(Vec3::Zero(), 1e6 * Mat3::Identity());
    const int patch = memory.AddPair({0, 1, Pose(p)}, {}, law, 0, &solver);
    for (int i = 0; i < 4; ++i) {
      contact::Contact c;
      c.p_WC = p + Vec3(i < 2 ? -0.02 : 0.02, i % 2 == 0 ? -0.02 : 0.02, 0);
      c.distance = p.z();
      ConstraintSolver::Contact contact;
      contact.patch = patch;
      contact.velocity_bias = -c.distance / kDt;
      contact.compliance = 1e-7;
      (void)memory.AddContact(c, contact, &solver);
    }
    V = solver.Solve(100);
    memory.EndTick(solver, kDt);
    p += kDt * V.v;
    force = 0;
    for (int i = 0; i < 4; ++i) {
      force += solver.contact_force(i).x();
    }
  }
};

// Before it breaks away the block gives by F / k, and comes back when the pull ends; it breaks away
// at mu_s N, within the steps of the ramp.
TEST(FrictionMemory, BendsElasticallyUpToTheBreakaway) {
  Slider slider;
  for (int i = 0; i < 200; ++i) {
    slider.Step(0);
  }
  const double start = slider.p.x();
  double pull = 0;
  const auto ramp_to = [&](double target) {
    for (double step = std::copysign(5e-3, target - pull); std::abs(target - pull) > 1e-9;) {
      pull += step;
      slider.Step(pull);
    }
  };
  for (const double target : {0.5, 2.9, -2.9, -1.0, 0.0}) {
    ramp_to(target);
    EXPECT_NEAR(slider.p.x() - start, pull / slider.law.stiffness, 2e-8) << pull;
  }
  while (slider.p.x() - start < 20e-6 && pull < 10) {
    pull += 1e-3;
    slider.Step(pull);
  }
  EXPECT_NEAR(pull, 0.3 * kLoad, 0.02 * kLoad * 0.3);
}

// Stribeck's curve: led at an even speed, the block is held back by mu(v) N, within 1 %.
TEST(FrictionMemory, SlidesAlongStribecksCurve) {
  for (const double v : {1e-3, 3e-3, 5e-3, 10e-3, 50e-3, 0.5}) {
    Slider slider;
    for (int i = 0; i < 400; ++i) {
      slider.Step(0, v, 1e5);
    }
    const double expected = slider.law.CalcCoefficient(v) * kLoad;
    EXPECT_NEAR(-slider.force, expected, 0.01 * expected) << v;
  }
}

// Passive: over 10,000 random pulls the friction never gives back more than was put into it; the
// bristles hold at most (mu_s N)^2 / 2k.
TEST(FrictionMemory, GivesNoEnergy) {
  Slider slider;
  Random random(7);
  double work = 0;  // Done by friction on the block.
  double stored = 0;
  double pull = 0;
  for (int i = 0; i < 10'000; ++i) {
    pull = i % 37 == 0 ? random.Uniform(-5, 5) : pull;
    slider.Step(pull);
    work += kDt * slider.force * slider.V.v.x();
    stored = std::max(stored, work);
  }
  EXPECT_LT(stored, 3.0 * 3.0 / 2e6 + 1e-9);
  EXPECT_LT(work, -0.1);
}

// Dragged round on the spot, a ring of contacts resists with mu N R, from whichever start.
TEST(FrictionMemory, ResistsTurningAboutTheNormal) {
  ConstraintSolver solver;
  FrictionMemory memory;
  const fits::FrictionLaw law{0.3, 0.3};
  const double radius = 0.02;
  Twist V;
  double torque = 0;
  for (int k = 0; k < 200; ++k) {
    memory.BeginTick();
    solver.Begin(1, 1e-3 * Mat3::Identity(), Vec3::Zero(), V, kDt);
    solver.AddWrench({Vec3::Zero(), Vec3(0, 0, -kLoad)});
    solver.AddAngularDamper(Vec3(0, 0, 1), 1e3);
    const int patch = memory.AddPair({0, 1, Pose()}, {}, law, 0, &solver);
    for (int i = 0; i < 8; ++i) {
      contact::Contact c;
      const double a = 0.1 + i * std::numbers::pi / 4;
      c.p_WC = radius * Vec3(std::cos(a), std::sin(a), 0);
      ConstraintSolver::Contact contact;
      contact.patch = patch;
      contact.compliance = 1e-7;
      (void)memory.AddContact(c, contact, &solver);
    }
    V = solver.Solve(200);
    memory.EndTick(solver, kDt);
    torque = 0;
    for (int i = 0; i < 8; ++i) {
      const double a = 0.1 + i * std::numbers::pi / 4;
      const Vec3 r = radius * Vec3(std::cos(a), std::sin(a), 0);
      torque += r.cross(solver.contact_force(i)).z();
    }
  }
  EXPECT_NEAR(-torque, 0.3 * kLoad * radius, 0.01 * 0.3 * kLoad * radius);
}

// A part pressed on a slope of 10 degrees, mu 0.3, does not creep: within 1 um in ten seconds.
TEST(Friction, PressedPartStaysOnASlope) {
  TickOptions options;
  options.contact.friction.static_coefficient = 0.3;
  options.contact.friction.kinetic_coefficient = 0.3;
  const double slope = 10 * std::numbers::pi / 180;
  // The slope is the way gravity points; the hand presses straight down, along it.
  const Vec3 down(std::sin(slope), 0, -std::cos(slope));
  options.gravity_W = 9.81 * down;
  const Vec3 half(0.01, 0.01, 0.01);
  BlockRig rig(Build(Block(half)), 0.2, Pose(Vec3(0, 0, 0.01002)), options);
  rig.part.I_BBcm_B = 0.2 / 3 * 2e-4 * Mat3::Identity();
  rig.hand->MoveSoftly(4e-3 * down, 0.5);
  rig.hand->Wait(0.5);
  const Pose X_rest = rig.hand->last().X_WD;
  double most = 0;
  for (int i = 0; i < 100; ++i) {
    rig.hand->Wait(0.1);
    most = std::max(most, (rig.hand->last().X_WD.p() - X_rest.p()).norm());
  }
  EXPECT_LT(most, 1e-6);
  // It is friction that holds it: the hand alone would not.
  const Vec3 f = rig.hand->last().F_felt_W.f;
  EXPECT_GT(f.head<2>().norm(), 0.5);
}

}  // namespace
}  // namespace hvas::haptics
