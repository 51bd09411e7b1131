#include "fits/fit_force.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

/** W7's rig with a given radial clearance. */
FitForceParameters MakeRig(double clearance_um, double roughness_um = 0, std::uint64_t seed = 0) {
  FitForceParameters p;
  p.nominal_diameter = 0.04;
  p.shaft_diameter = 0.04;
  p.hole_diameter = 0.04 + 2 * units::FromUm(clearance_um);
  p.length = 0.05;
  p.roughness = units::FromUm(roughness_um);
  p.seed = seed;
  return p;
}

// W(8): 3711.01 N per micrometre of radial interference at full depth, and the classes' ends.
TEST(FitForce, MatchesTheAnchorsOfTheRig) {
  struct Anchor {
    double clearance_um;
    double force;
    double pressure_mpa;
    double tolerance;
  };

  for (const Anchor& anchor :
       {Anchor{-1, 3711.01, 3.9375, 0.005}, Anchor{-0.5, 1855.5, 1.969, 0.05},
        Anchor{-10.75, 39893.3, 42.328, 0.06}, Anchor{-21, 77931.13, 82.688, 0.005},
        Anchor{-9, 33399.1, 35.438, 0.05}, Anchor{1, 0, 0, 0}, Anchor{0, 0, 0, 1e-6},
        Anchor{14.75, 0, 0, 0}}) {
    const FitForce fit = *FitForce::Make(MakeRig(anchor.clearance_um));
    EXPECT_NEAR(fit.CalcAxialResistance(0.05), anchor.force, anchor.tolerance);
    EXPECT_NEAR(units::ToMpa(fit.CalcPressure(0.02)), anchor.pressure_mpa, 6e-4);
    EXPECT_NEAR(units::ToUm(fit.CalcClearance(0.03)), anchor.clearance_um, 1e-9);
  }
}

// The printed sum over time steps, whatever the step, meets the table: W(8) is a function of depth.
TEST(FitForce, EqualsThePrintedSumForAnyStep) {
  const FitForce fit = *FitForce::Make(MakeRig(-21));
  for (const double step : {1e-6, 1e-5, 1e-3}) {
    double sum = 0;
    const int steps = static_cast<int>(std::lround(0.05 / step));
    for (int i = 0; i < steps; ++i) {
      sum += 0.15 * std::numbers::pi * 210e9 * (1 - 0.25) * step *
             std::max(0.0, -fit.CalcClearance((i + 0.5) * step));
    }
    EXPECT_NEAR(sum, 77931.133, 0.001);
    EXPECT_NEAR(fit.max_resistance(), sum, 1e-6 * sum);
  }
}

// W(6) with W(7): the same force from the pressure, as an independent quadrature.
TEST(FitForce, RoughSurfacesIntegrateExactly) {
  for (const double clearance_um : {-5.0, -1.0, 0.0, 1.0, 2.5}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const FitForce fit = *FitForce::Make(MakeRig(clearance_um, 6.3, seed));
      constexpr int kSteps = 20000;
      const double step = 0.05 / kSteps;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        sum += 0.15 * 2 * std::numbers::pi * 0.02 * fit.CalcPressure((i + 0.5) * step) * step;
        if (i % 1000 == 999) {
          EXPECT_NEAR(fit.CalcAxialResistance((i + 1) * step), sum, 1e-4 * sum + 1e-3);
        }
      }
    }
  }
}

// Paper W's transition fit: mean forces at full depth of 20 stations with Rz 6.3 um.
TEST(FitForce, MeanOverRandomSurfacesMatchesTheMonteCarloFigures) {
  const auto mean = [](double clearance_um) {
    double sum = 0;
    constexpr int kDraws = 20000;
    for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
      sum += FitForce::Make(MakeRig(clearance_um, 6.3, seed))->max_resistance();
    }
    return sum / kDraws;
  };
  EXPECT_NEAR(mean(0), 2329, 25);
  EXPECT_NEAR(mean(-1), 4590, 35);
  EXPECT_NEAR(mean(-3.15), 11696, 40);
}

TEST(FitForce, W1ClearanceStaysWithinHalfTheRoughness) {
  double least = 0;
  double most = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const FitForce fit = *FitForce::Make(MakeRig(14.75, 6.3, seed));
    for (int i = 0; i <= 100; ++i) {
      const double b = units::ToUm(fit.CalcClearance(i * 0.0005)) - 14.75;
      least = std::min(least, b);
      most = std::max(most, b);
    }
    EXPECT_EQ(fit.max_resistance(), 0);  // W4: 9 um and more of clearance never press.
  }
  EXPECT_GE(least, -3.15 - 1e-9);
  EXPECT_LE(most, 3.15 + 1e-9);
  EXPECT_LT(least, -3.1);
  EXPECT_GT(most, 3.1);
}

// W(1): linear between the stations, continuous through them, and j = 0 is defined (W(3)).
TEST(FitForce, ClearanceIsLinearBetweenStations) {
  const FitForce fit = *FitForce::Make(MakeRig(0, 6.3, 5));
  const double step = 0.05 / 20;
  for (int j = 0; j < 20; ++j) {
    const double a = fit.CalcClearance(j * step);
    const double b = fit.CalcClearance((j + 1) * step);
    for (const double share : {0.1, 0.5, 0.9}) {
      EXPECT_NEAR(fit.CalcClearance((j + share) * step), (1 - share) * a + share * b, 1e-16);
    }
  }
}

// W5, W6: grows with depth, flat where S >= 0; the same on the way out, being a function of depth.
TEST(FitForce, W6ResistanceNeverFallsAndRestsWhereThereIsClearance) {
  int flat = 0;
  int rising = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const FitForce fit = *FitForce::Make(MakeRig(0.5, 6.3, seed));
    double before = 0;
    for (int i = 1; i <= 1000; ++i) {
      const double depth = i * 0.05 / 1000;
      const double force = fit.CalcAxialResistance(depth);
      EXPECT_GE(force, before - 1e-9 * fit.max_resistance());
      if (fit.CalcClearance(depth) >= 0 && fit.CalcClearance(depth - 0.05 / 1000) >= 0) {
        EXPECT_NEAR(force, before, 1e-9 * fit.max_resistance());
        ++flat;
      } else {
        ++rising;
      }
      before = force;
    }
  }
  EXPECT_GT(flat, 10000);
  EXPECT_GT(rising, 10000);
}

TEST(FitForce, RadialPlayIsTheLeastClearanceSoFar) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const FitForce fit = *FitForce::Make(MakeRig(2, 6.3, seed));
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 2000; ++i) {
      const double depth = i * 0.05 / 2000;
      least = std::min(least, std::max(0.0, fit.CalcClearance(depth)));
      EXPECT_NEAR(fit.CalcRadialPlay(depth), least, 1e-12);
    }
  }
}

TEST(FitForce, DepthsOutsideAreClamped) {
  const FitForce fit = *FitForce::Make(MakeRig(-3, 6.3, 1));
  EXPECT_EQ(fit.CalcAxialResistance(-1), 0);
  EXPECT_EQ(fit.CalcAxialResistance(0), 0);
  EXPECT_EQ(fit.CalcAxialResistance(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_NEAR(fit.CalcAxialResistance(1), fit.max_resistance(), 1e-9 * fit.max_resistance());
  EXPECT_EQ(fit.CalcClearance(1), fit.CalcClearance(0.05));
}

/** A bronze hub on a hollow steel shaft, drawn out harder than it slides. */
FitForceParameters MakePair(double clearance_um) {
  FitForceParameters p = MakeRig(clearance_um);
  p.hub_diameter = 0.07;
  p.shaft_bore = 0.018;
  p.hub.youngs_modulus = 110e9;
  p.hub.poisson_ratio = 0.34;
  p.smoothing = Smoothing::kDin2017;  // Of no roughness, unless somebody gives it one.
  p.friction = {0.12, 0.2, 0.17, 0.18};
  return p;
}

// N5: what the hand feels at a depth is what a press fit of that length is calculated to need.
TEST(FitForce, IsThePressFitOfItsDepth) {
  for (const double clearance_um : {-30.0, -8.0, -1.0, 3.0}) {
    const FitForceParameters p = MakePair(clearance_um);
    const FitForce fit = *FitForce::Make(p);
    for (const double depth : {0.1e-3, 7.3e-3, 25e-3, 50e-3}) {
      PressFitParameters press;
      press.joint_diameter = 0.04;
      press.hub_diameter = 0.07;
      press.shaft_bore = 0.018;
      press.length = depth;
      press.interference = p.shaft_diameter - p.hole_diameter;
      press.smoothing = p.smoothing;
      press.hub = p.hub;
      press.friction_in = 0.12;
      press.friction_release = 0.2;
      press.friction_torque = 0.18;
      const PressFit closed = *CalcPressFit(press);
      EXPECT_NEAR(fit.CalcAxialResistance(depth), closed.press_in_force,
                  1e-9 * closed.press_in_force);
      EXPECT_NEAR(fit.CalcReleaseForce(depth), closed.push_out_force, 1e-9 * closed.push_out_force);
      EXPECT_NEAR(fit.CalcTorque(depth), closed.torque, 1e-9 * closed.torque);
      EXPECT_NEAR(fit.CalcPressure(depth), closed.pressure, 1e-9 * closed.pressure);
    }
  }
}

// N5: where the surfaces are rough, smoothing takes its share of the pressure and of the force
// alike: they are those of even parts with as much less interference, k (Rz_A + Rz_I).
TEST(FitForce, SmoothingTakesItsShareOfPressureAndForceAtEveryDepth) {
  for (const Smoothing edition : {Smoothing::kDin2001, Smoothing::kDin2017}) {
    FitForceParameters p = MakePair(-20);
    p.roughness = 6.3e-6;
    p.seed = 3;
    p.smoothing = Smoothing::kNone;
    const FitForce peaks = *FitForce::Make(p);
    p.smoothing = edition;
    const FitForce flat = *FitForce::Make(p);
    const double loss = GetSmoothingFactor(edition) * 2 * 6.3e-6;  // diametral
    p.smoothing = Smoothing::kNone;
    p.hole_diameter += loss;
    const FitForce looser = *FitForce::Make(p);
    const double stiffness = peaks.CalcPressure(0.02) / -(2 * peaks.CalcClearance(0.02));
    EXPECT_NEAR(peaks.max_pressure() - flat.max_pressure(), stiffness * loss,
                1e-9 * peaks.max_pressure());
    for (const double depth : {0.4e-3, 11.1e-3, 29e-3, 50e-3}) {
      EXPECT_EQ(flat.CalcClearance(depth), peaks.CalcClearance(depth)) << "as measured";
      EXPECT_NEAR(peaks.CalcPressure(depth) - flat.CalcPressure(depth), stiffness * loss,
                  1e-9 * peaks.max_pressure());
      EXPECT_NEAR(flat.CalcPressure(depth), looser.CalcPressure(depth),
                  1e-9 * peaks.max_pressure());
      EXPECT_NEAR(flat.CalcAxialResistance(depth), looser.CalcAxialResistance(depth),
                  1e-9 * peaks.max_resistance());
    }
  }
}

// N5: breaking loose takes more than sliding on, and nothing in between jumps.
TEST(FitForce, ReleaseFallsToItsSlidingValueWithSpeed) {
  const FitForce fit = *FitForce::Make(MakePair(-20));
  const double normal = fit.CalcNormalForce(0.03);
  EXPECT_NEAR(fit.CalcReleaseForce(0.03), 0.2 * normal, 1e-9 * normal);
  EXPECT_NEAR(fit.CalcReleaseForce(0.03, 0.1), 0.17 * normal, 1e-9 * normal);
  double before = fit.CalcReleaseForce(0.03);
  for (int i = 1; i <= 1000; ++i) {
    const double force = fit.CalcReleaseForce(0.03, i * 1e-5);
    EXPECT_LE(force, before);
    EXPECT_GT(force, before - 1e-3 * normal);
    before = force;
  }
}

// N5: run-in. Before the edge is at the mouth the chamfer alone presses, and it takes no work back.
TEST(FitForce, ChamferIsFeltInFrontOfTheMouthAndOnlyInwards) {
  FitForceParameters p = MakeRig(-21);
  const FitForce sharp = *FitForce::Make(p);
  constexpr double kAngle = 0.2;
  p.lead_in_angle = kAngle;
  const FitForce fit = *FitForce::Make(p);
  const double ramp = 21e-6 / std::tan(kAngle);
  EXPECT_EQ(fit.CalcAxialResistance(-1.01 * ramp), 0);
  double before = 0;
  for (int i = 1; i <= 100; ++i) {
    const double force = fit.CalcAxialResistance((i - 100) * ramp / 100);
    EXPECT_GT(force, before);
    before = force;
  }
  // The ring of the edge, widened without friction: half its force times how far it gives way,
  // divided by the chamfer's length; friction on the slope on top.
  const double ring = std::numbers::pi * 0.04 * 82.688e6;  // [N/m]
  const double factor = std::tan(kAngle + std::atan(0.15)) / std::tan(kAngle);
  EXPECT_NEAR(before, 0.5 * ring * 21e-6 * factor, 0.01);
  for (const double depth : {1e-3, 20e-3, 40e-3}) {
    EXPECT_NEAR(fit.CalcAxialResistance(depth) - sharp.CalcAxialResistance(depth), before, 1e-6);
    EXPECT_LE(fit.CalcReleaseForce(depth), sharp.CalcReleaseForce(depth));
    EXPECT_GT(fit.CalcReleaseForce(depth), 0);
  }
  EXPECT_GE(fit.CalcReleaseForce(-0.5 * ramp), 0);
}

// The stiffness of the engaged length against the sum of its rings' pressures, a ring at a time.
TEST(FitForce, StiffnessIsThatOfABedOfRings) {
  const FitForce fit = *FitForce::Make(MakePair(-20));
  const double bed = 2 * fit.CalcPressure(0) / 40e-6;  // [Pa/m] of radius
  constexpr double kDepth = 0.03;
  double across = 0;
  double tilt = 0;
  constexpr int kRings = 200;
  constexpr int kSectors = 90;
  for (int i = 0; i < kRings; ++i) {
    const double z = ((i + 0.5) / kRings - 0.5) * kDepth;
    for (int k = 0; k < kSectors; ++k) {
      const double c = std::cos(2 * std::numbers::pi * k / kSectors);
      const double area = 2 * std::numbers::pi * 0.02 / kSectors * kDepth / kRings;
      across += bed * c * c * area;
      tilt += bed * z * z * c * c * area;
    }
  }
  EXPECT_NEAR(fit.CalcRadialStiffness(kDepth), across, 1e-6 * across);
  EXPECT_NEAR(fit.CalcTiltStiffness(kDepth), tilt, 1e-4 * tilt);
  EXPECT_EQ(fit.CalcRadialStiffness(-1), 0);
}

TEST(FitForce, RefusesWhatIsNoFit) {
  const auto fails = [](auto&& spoil) {
    FitForceParameters p = MakeRig(0);
    spoil(&p);
    const Result<FitForce> fit = FitForce::Make(p);
    return !fit.has_value() && fit.error().code == ErrorCode::kInvalid &&
           !fit.error().remedy.empty();
  };
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->hole_diameter = 0; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->shaft_diameter = -1; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->nominal_diameter = std::nan(""); }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->length = 0; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->hub_diameter = p->nominal_diameter; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->shaft_bore = p->nominal_diameter; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->hub.youngs_modulus = 0; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->friction.in = -0.1; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->friction.slip = 0.2; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->lead_in_angle = 1.5; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->roughness = -1e-6; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->stations = 0; }));
}

// W1b, paper W, 2.1: diameters that are measured at a few places count with their values between.
TEST(FitForce, DiametersAlongTheLengthAreInterpolated) {
  FitForceParameters p = MakeRig(0);
  p.hole_diameters = {{10e-3, 40.002e-3}, {30e-3, 40.010e-3}};
  p.shaft_diameters = {{0, 40.000e-3}, {50e-3, 40.010e-3}};
  const FitForce fit = *FitForce::Make(p);
  EXPECT_NEAR(fit.CalcClearance(0), 0.5 * 2e-6, 1e-12);      // constant before the first place
  EXPECT_NEAR(fit.CalcClearance(10e-3), 0.5 * 0e-6, 1e-12);  // 40.002 - 40.002
  EXPECT_NEAR(fit.CalcClearance(20e-3), 0.5 * 2e-6, 1e-12);  // 40.006 - 40.004
  EXPECT_NEAR(fit.CalcClearance(50e-3), 0.5 * 0e-6, 1e-12);  // 40.010 - 40.010
  EXPECT_NEAR(fit.CalcAxialResistance(50e-3), 0, 1e-6);
}

// A cone in a cylinder: the interference grows along the length, so the force is its integral.
TEST(FitForce, TaperedShaftHasTheForceOfTheIntegral) {
  FitForceParameters p = MakeRig(0);
  p.shaft_diameters = {{0, 40.000e-3}, {50e-3, 40.020e-3}};
  const FitForce fit = *FitForce::Make(p);
  // Radial interference 0 to 10 um, 5 um in the mean: 3711.01 N each.
  EXPECT_NEAR(fit.CalcAxialResistance(50e-3), 5 * 3711.01, 0.1);
  EXPECT_NEAR(fit.CalcAxialResistance(25e-3), 5 * 3711.01 / 4, 0.1);
}

TEST(FitForce, RefusesPlacesThatDoNotAscend) {
  FitForceParameters p = MakeRig(0);
  p.hole_diameters = {{10e-3, 40e-3}, {10e-3, 40e-3}};
  EXPECT_FALSE(FitForce::Make(p));
  p.hole_diameters = {{-1e-3, 40e-3}};
  EXPECT_FALSE(FitForce::Make(p));
  p.hole_diameters = {{0, 0}};
  EXPECT_FALSE(FitForce::Make(p));
}

/** A tongue in a slot of 12 mm in a part of 36 mm, 20 mm deep and 30 mm broad. */
FitForceParameters MakeFlat(double clearance_um, double roughness_um, std::uint64_t seed) {
  FitForceParameters p;
  p.nominal_diameter = p.shaft_diameter = 0.012;
  p.hole_diameter = 0.012 + units::FromUm(clearance_um);
  p.hub_diameter = 0.036;
  p.breadth = 0.03;
  p.length = 0.02;
  p.roughness = units::FromUm(roughness_um);
  p.seed = seed;
  return p;
}

TEST(FitForce, FlatWallsResistInProportionToTheirDepth) {
  const FitForce fit = *FitForce::Make(MakeFlat(-20, 0, 0));
  const double pressure = 20e-6 * 210e9 / (1 - 0.3 * 0.3) / 0.036;
  for (const double depth : {0.0, 1e-3, 7e-3, 20e-3}) {
    const double force = 0.15 * 2 * 0.03 * depth * pressure;
    EXPECT_NEAR(fit.CalcAxialResistance(depth), force, 1e-9 * force + 1e-9);
    EXPECT_NEAR(fit.CalcReleaseForce(depth), force, 1e-9 * force + 1e-9);
    EXPECT_EQ(fit.CalcTorque(depth), 0);
  }
  EXPECT_NEAR(fit.CalcPressure(0.01), pressure, 1e-6 * pressure);
}

TEST(FitForce, FlatWallsOfRoughSurfacesSumUpTheirPressure) {
  for (const double clearance_um : {-10.0, 0.0, 4.0}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const FitForce fit = *FitForce::Make(MakeFlat(clearance_um, 6.3, seed));
      constexpr int kSteps = 20000;
      double sum = 0;
      double last = 0;
      for (int i = 0; i < kSteps; ++i) {
        sum += fit.CalcPressure((i + 0.5) * 0.02 / kSteps) * 2 * 0.03 * 0.02 / kSteps;
        const double force = fit.CalcAxialResistance((i + 1) * 0.02 / kSteps);
        EXPECT_GE(force, last - 1e-9) << "but for rounding";
        last = force;
      }
      EXPECT_NEAR(fit.CalcNormalForce(0.02), sum, 1e-5 * sum + 1e-9);
    }
  }
}

TEST(FitForce, FlatWallsPushBackByTheirPressureOverOneWall) {
  const FitForce fit = *FitForce::Make(MakeFlat(10, 0, 0));
  // A tongue that is pressed into one wall by x: the pressure of an interference of 2 x.
  const double x = 1e-6;
  const FitForce pressed = *FitForce::Make(MakeFlat(units::ToUm(-2 * x), 0, 0));
  const double force = pressed.CalcPressure(0.01) * 0.03 * 0.02;
  EXPECT_NEAR(fit.CalcRadialStiffness(0.02) * x, force, 1e-6 * force);
  EXPECT_NEAR(fit.CalcRadialPlay(0.02), 5e-6, 1e-12);
}

}  // namespace
}  // namespace hvas::fits
