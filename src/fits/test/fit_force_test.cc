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
  p.radius_ratio = 0.5;
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

TEST(FitForce, ClearanceStaysWithinHalfTheRoughness) {
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
TEST(FitForce, ResistanceNeverFallsAndRestsWhereThereIsClearance) {
  int flat = 0;
  int rising = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const FitForce fit = *FitForce::Make(MakeRig(0.5, 6.3, seed));
    double before = 0;
    for (int i = 1; i <= 1000; ++i) {
      const double depth = i * 0.05 / 1000;
      const double force = fit.CalcAxialResistance(depth);
      EXPECT_GE(force, before);
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
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->radius_ratio = 1; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->youngs_modulus = 0; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->friction = -0.1; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->roughness = -1e-6; }));
  EXPECT_TRUE(fails([](FitForceParameters* p) { p->stations = 0; }));
}

}  // namespace
}  // namespace hvas::fits
