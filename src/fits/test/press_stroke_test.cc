// Force along the stroke: W5, W6, W8, W9, N4, N5.

#include "fits/press_stroke.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"

namespace hvas::fits {
namespace {

/** Paper W's rig: 40 mm, hub 80 mm, 50 mm long, steel, mu 0.15; S = -21 um. */
StrokeLand PaperLand() {
  StrokeLand land;
  land.press.joint_diameter = 0.04;
  land.press.hub_diameter = 0.08;
  land.press.length = 0.05;
  land.press.interference = 42e-6;
  return land;
}

// W8: 77,931.13 N at the end whatever the step: 1 um, 10 um, 1 mm. Summed as the paper does, and by
// the stroke with as many stations.
TEST(PressStroke, ForceAtTheEndDoesNotDependOnTheStep) {
  for (const double step_um : {1.0, 10.0, 1000.0}) {
    StrokeLand land = PaperLand();
    const auto steps = static_cast<std::size_t>(std::lround(50e3 / step_um));
    land.clearances.assign(steps + 1, -21e-6);
    const PressStroke stroke = *PressStroke::Make({land});
    EXPECT_NEAR(stroke.CalcForce(0.05).in, 77931.133, 0.005) << step_um;
    double summed = 0;
    double before = 0;
    for (std::size_t i = 1; i <= steps; ++i) {
      const double here = stroke.CalcForce(units::FromUm(step_um) * static_cast<double>(i)).in;
      summed += here - before;
      before = here;
    }
    EXPECT_NEAR(summed, 77931.133, 0.005) << step_um;
  }
}

// N4: a smoothed joint pushed in all the way has the closed form's force, which loses G as well.
TEST(PressStroke, SmoothedForceAtTheEndIsTheClosedForm) {
  for (const Smoothing edition : {Smoothing::kDin2001, Smoothing::kDin2017}) {
    StrokeLand land = PaperLand();
    land.press.hub_roughness = 4e-6;
    land.press.shaft_roughness = 6.3e-6;
    land.press.smoothing = edition;
    const PressFit joint = *CalcPressFit(land.press);
    const StrokeForce force = PressStroke::Make({land})->CalcForce(0.05);
    EXPECT_NEAR(force.in, joint.press_in_force, 1e-9 * joint.press_in_force);
    EXPECT_LT(force.in, 0.95 * 77931.133);
  }
}

// N4: partly in, a joint has the force of one as long as the part that is in; out of it, none.
TEST(PressStroke, PartialEngagementIsAShorterJoint) {
  const PressStroke stroke = *PressStroke::Make({PaperLand()});
  for (const double depth : {0.001, 0.0123, 0.03, 0.05}) {
    StrokeLand land = PaperLand();
    land.press.length = depth;
    const PressFit joint = *CalcPressFit(land.press);
    EXPECT_NEAR(stroke.CalcForce(depth).in, joint.press_in_force, 1e-9 * joint.press_in_force);
    EXPECT_NEAR(stroke.CalcForce(depth).release, joint.push_out_force, 1e-9 * joint.press_in_force);
  }
  EXPECT_EQ(stroke.CalcForce(-0.001).in, 0);
  EXPECT_EQ(stroke.CalcForce(0.07).in, stroke.CalcForce(0.05).in);
}

// N4: lands add up, each from its own depth.
TEST(PressStroke, LandsAddUp) {
  StrokeLand first = PaperLand();
  first.press.length = 0.02;
  StrokeLand second = PaperLand();
  second.press.joint_diameter = 0.03;
  second.press.interference = 20e-6;
  second.press.length = 0.01;
  second.start = 0.04;
  const PressStroke both = *PressStroke::Make({first, second});
  const PressStroke one = *PressStroke::Make({first});
  const PressStroke other = *PressStroke::Make({second});
  EXPECT_EQ(both.end(), 0.05);
  for (double depth = 0; depth < 0.06; depth += 0.0007) {
    EXPECT_DOUBLE_EQ(both.CalcForce(depth).in, one.CalcForce(depth).in + other.CalcForce(depth).in);
  }
  EXPECT_EQ(both.CalcForce(0.039).in, one.CalcForce(0.02).in);
}

// W6: where the parts have clearance the force does not grow; it never falls. By a fine sum.
TEST(PressStroke, RoughTransitionFitIsAStairEqualToAFineSum) {
  StrokeLand land = PaperLand();
  land.clearances = DrawClearances(1e-6, 6.3e-6, 20, 5);
  const PressStroke stroke = *PressStroke::Make({land});
  const PressFit fit = *CalcPressFit(land.press);
  const double scale = 0.15 * std::numbers::pi * 0.04 * 2 * fit.pressure_per_interference;
  constexpr int kSteps = 200'000;
  double sum = 0;
  int flat = 0;
  int rising = 0;
  double before = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double at = (i + 0.5) / kSteps * 20;
    const auto j = static_cast<std::size_t>(at);
    const double s = land.clearances[j] +
                     (at - static_cast<double>(j)) * (land.clearances[j + 1] - land.clearances[j]);
    sum += scale * std::max(0.0, -s) * 0.05 / kSteps;
    if (i % 1000 == 999) {
      const double force = stroke.CalcForce(0.05 * (i + 1) / kSteps).in;
      EXPECT_NEAR(force, sum, 1e-3);
      EXPECT_GE(force, before - 1e-9);  // Rounding at a station.
      (force > before + 1e-6 ? rising : flat) += 1;
      before = force;
    }
  }
  EXPECT_GT(flat, 20);
  EXPECT_GT(rising, 20);
}

// N5: the chamfer's own force by hand: ring by ring along the slope, each pressed on an incline.
TEST(PressStroke, ChamferEqualsRingsOnAnIncline) {
  StrokeLand land = PaperLand();
  land.lead_in_angle = units::FromDeg(5);
  const PressStroke stroke = *PressStroke::Make({land});
  const double t = std::tan(land.lead_in_angle);
  EXPECT_NEAR(stroke.begin(), -21e-6 / t, 1e-12);
  const PressFit fit = *CalcPressFit(land.press);
  constexpr int kRings = 100'000;
  for (const double depth : {-0.0001, 0.0, 0.01, 0.0499}) {
    const double from = stroke.begin();
    double in = 0;
    double out = 0;
    for (int i = 0; i < kRings; ++i) {
      const double ahead = -from * (i + 0.5) / kRings;  // Of the edge.
      const double z = depth + ahead;
      if (z < 0 || z > 0.05) {
        continue;
      }
      const double n = 2 * (21e-6 - t * ahead);
      const double normal =
          n * fit.pressure_per_interference * std::numbers::pi * 0.04 * -from / kRings;
      // Equilibrium of a ring on a slope: normal N, friction mu N against motion, radial load
      // given.
      const double c = std::cos(land.lead_in_angle);
      const double s = std::sin(land.lead_in_angle);
      in += normal * (s + 0.15 * c) / (c - 0.15 * s);
      out += normal * (0.15 * c - s) / (c + 0.15 * s);
    }
    const double body = fit.press_in_force * std::max(0.0, depth) / 0.05;
    EXPECT_NEAR(stroke.CalcForce(depth).in, body + in, 1e-4 * (body + in));
    EXPECT_NEAR(stroke.CalcForce(depth).release, body + out, 1e-4 * (body + in));
  }
  // Quite in, the chamfer is through.
  EXPECT_NEAR(stroke.CalcForce(0.05).in, 77931.133, 0.005);
}

// Work: of a force that grows evenly, half the last one times the way.
TEST(PressStroke, WorkOfAnEvenJointIsTheTriangle) {
  const PressStroke stroke = *PressStroke::Make({PaperLand()});
  EXPECT_NEAR(stroke.CalcWork(), 0.5 * 77931.133 * 0.05, 1e-3);
}

TEST(PressStroke, RefusesWhatIsNoStroke) {
  EXPECT_FALSE(PressStroke::Make({}));
  StrokeLand land = PaperLand();
  land.start = -1;
  EXPECT_FALSE(PressStroke::Make({land}));
  land = PaperLand();
  land.lead_in_angle = units::FromDeg(85);  // Friction 0.15 locks from 81.5 degrees.
  EXPECT_FALSE(PressStroke::Make({land}));
  land = PaperLand();
  land.clearances = {1e-6};
  EXPECT_FALSE(PressStroke::Make({land}));
  land = PaperLand();
  land.press.hub_diameter = 0.03;
  EXPECT_FALSE(PressStroke::Make({land}));
}

}  // namespace
}  // namespace hvas::fits
