#include "fits/press_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"

namespace hvas::fits {
namespace {

PressFitParameters MakeFit(double d_mm, double hub_mm, double bore_mm, double u_um, double l_mm,
                           double mu, double e_hub_gpa = 210, double nu_hub = 0.3) {
  PressFitParameters p;
  p.joint_diameter = units::FromMm(d_mm);
  p.hub_diameter = units::FromMm(hub_mm);
  p.shaft_bore = units::FromMm(bore_mm);
  p.length = units::FromMm(l_mm);
  p.interference = units::FromUm(u_um);
  p.friction_in = p.friction_release = p.friction_torque = mu;
  p.hub.youngs_modulus = units::FromGpa(e_hub_gpa);
  p.hub.poisson_ratio = nu_hub;
  return p;
}

// N4: published examples (dsoftcon.be PressShrinkFit manual, novasolver.jp, an Ugural exercise, PSU
// problem S14), to the digits that they were computed with.
TEST(PressFit, EqualsPublishedExamples) {
  struct Case {
    PressFitParameters parameters;
    double pressure_mpa, expansion_mm, contraction_mm, hoop_mpa, mises_mpa, tresca_mpa, shaft_mpa;
    double force, torque;
  };

  PressFitParameters s14 = MakeFit(40, 80, 0, 26, 1, 0.15, 205);
  s14.shaft.youngs_modulus = 205e9;
  const Case cases[] = {
      {MakeFit(70, 140, 0, 84, 60, 0.09, 215), 96.149068, 0.061565217, 0.022434783, 160.24845,
       224.34783, 256.39752, -96.149068, 114179.14, 3996.2698},
      {MakeFit(70, 140, 0, 35, 60, 0.09, 215), 40.062112, 0.025652174, 0.0093478261, 66.770186,
       93.478261, 106.8323, -40.062112, 47574.64, 1665.1124},
      {MakeFit(100, 150, 0, 100, 50, 0.15), 58.333333, 0.080555556, 0.019444444, 151.66667,
       187.75723, 210, -58.333333, 137444.68, 6872.2339},
      {MakeFit(100, 250, 50, 64.754204, 100, 0.15, 70, 0.25), 21.724309, 0.050616162, 0.014138042,
       30.000236, 44.985488, 51.724545, -57.93149, 102373.39, 5118.6697},
      {s14, 49.96875, 0.019175, 0.006825, 83.28125, 116.59375, 133.25, -49.96875,
       0.15 * std::numbers::pi * 0.04 * 0.001 * 49.96875e6, 0},
  };
  const auto near = [](double expected) { return 1e-6 * std::abs(expected); };
  for (const Case& c : cases) {
    const PressFit fit = *CalcPressFit(c.parameters);
    EXPECT_NEAR(units::ToMpa(fit.pressure), c.pressure_mpa, near(c.pressure_mpa));
    EXPECT_NEAR(units::ToMm(fit.hub_expansion), c.expansion_mm, near(c.expansion_mm));
    EXPECT_NEAR(units::ToMm(fit.shaft_contraction), c.contraction_mm, near(c.contraction_mm));
    EXPECT_NEAR(units::ToMpa(fit.hub_bore.hoop), c.hoop_mpa, near(c.hoop_mpa));
    EXPECT_NEAR(units::ToMpa(fit.hub_bore.von_mises()), c.mises_mpa, near(c.mises_mpa));
    EXPECT_NEAR(units::ToMpa(fit.hub_bore.tresca()), c.tresca_mpa, near(c.tresca_mpa));
    EXPECT_NEAR(units::ToMpa(fit.shaft_governing.hoop), c.shaft_mpa, near(c.shaft_mpa));
    EXPECT_NEAR(fit.press_in_force, c.force, near(c.force));
    if (c.torque > 0) {
      EXPECT_NEAR(fit.torque, c.torque, near(c.torque));
    }
  }
}

// W(7), W(8): the paper's rig at S = -21 um, that is U = 42 um, needs 77,931.13 N.
TEST(PressFit, EqualsPaperWForOneMaterialAndASolidShaft) {
  const PressFit fit = *CalcPressFit(MakeFit(40, 80, 0, 42, 50, 0.15));
  EXPECT_NEAR(fit.press_in_force, 77931.13, 0.005);
  EXPECT_NEAR(units::ToMpa(fit.pressure), 82.6875, 1e-6);
  EXPECT_NEAR(units::ToMpa(fit.hub_bore.hoop), 137.8, 0.05);
  EXPECT_NEAR(units::ToMpa(fit.hub_bore.von_mises()), 192.9, 0.05);
  EXPECT_NEAR(units::ToMpa(fit.hub_bore.tresca()), 220.5, 0.05);
}

// Smoothing by edition: p6 at least, mean and most interference, Rz 6.3 um both.
TEST(PressFit, SmoothingTakesTheShareOfItsEdition) {
  struct Case {
    Smoothing edition;
    double u_um;
    double force;
  };

  for (const Case& c :
       {Case{Smoothing::kDin2001, 1, 0}, Case{Smoothing::kDin2001, 21.5, 21190},
        Case{Smoothing::kDin2001, 42, 59228}, Case{Smoothing::kDin2017, 21.5, 30542},
        Case{Smoothing::kDin2017, 42, 68579}}) {
    PressFitParameters p = MakeFit(40, 80, 0, c.u_um, 50, 0.15);
    p.hub_roughness = p.shaft_roughness = units::FromUm(6.3);
    p.smoothing = c.edition;
    EXPECT_NEAR(CalcPressFit(p)->press_in_force, c.force, 0.5);
  }
}

// Lame's solution by itself: radial displacements from the general ring, u(r) = A r + B / r, with
// both constants from the pressures at its two faces.
double RingDisplacement(double inside, double outside, double p_inside, double p_outside, double r,
                        const PressMaterial& m) {
  const double a2 = inside * inside;
  const double b2 = outside * outside;
  const double mean = (p_inside * a2 - p_outside * b2) / (b2 - a2);
  const double shear = (p_inside - p_outside) * a2 * b2 / (b2 - a2);
  return ((1 - m.poisson_ratio) * mean * r + (1 + m.poisson_ratio) * shear / r) / m.youngs_modulus;
}

TEST(PressFit, ExpansionsAddUpToTheInterferenceAndAreLamesRings) {
  Random random(7);
  for (int i = 0; i < 2000; ++i) {
    PressFitParameters p;
    p.joint_diameter = random.Uniform(0.002, 0.5);
    p.hub_diameter = p.joint_diameter * random.Uniform(1.05, 6);
    p.shaft_bore = i % 3 == 0 ? 0 : p.joint_diameter * random.Uniform(0.05, 0.95);
    p.length = random.Uniform(0.001, 0.5);
    p.interference = random.Uniform(1e-6, 2e-4);
    p.hub = {random.Uniform(2e9, 4e11), random.Uniform(0, 0.49), 0, 0, 0};
    p.shaft = {random.Uniform(2e9, 4e11), random.Uniform(0, 0.49), 0, 0, 0};
    const PressFit fit = *CalcPressFit(p);
    EXPECT_NEAR(fit.hub_expansion + fit.shaft_contraction, p.interference, 1e-12 * p.interference);
    const double r = 0.5 * p.joint_diameter;
    const double hub = RingDisplacement(r, 0.5 * p.hub_diameter, fit.pressure, 0, r, p.hub);
    const double shaft = RingDisplacement(0.5 * p.shaft_bore, r, 0, fit.pressure, r, p.shaft);
    EXPECT_NEAR(2 * hub, fit.hub_expansion, 1e-9 * fit.hub_expansion);
    EXPECT_NEAR(-2 * shaft, fit.shaft_contraction, 1e-9 * fit.shaft_contraction);
    EXPECT_NEAR(*CalcInterferenceFor(fit.pressure, p), p.interference, 1e-12 * p.interference);
  }
}

// The governing point reaches the strength exactly at the limit, by either hypothesis.
TEST(PressFit, LimitsAreWhereTheEquivalentStressReachesTheStrength) {
  for (const double bore_mm : {0.0, 20.0}) {
    PressFitParameters p = MakeFit(40, 80, bore_mm, 42, 50, 0.15);
    p.hub.yield_strength = p.shaft.yield_strength = 235e6;
    const PressFit fit = *CalcPressFit(p);
    const auto at = [&](double pressure) {
      PressFitParameters q = p;
      q.interference = *CalcInterferenceFor(pressure, p);
      return *CalcPressFit(q);
    };
    EXPECT_NEAR(at(fit.hub_limit.von_mises).hub_bore.von_mises(), 235e6, 1);
    EXPECT_NEAR(at(fit.hub_limit.tresca).hub_bore.tresca(), 235e6, 1);
    EXPECT_NEAR(at(fit.shaft_limit.von_mises).shaft_governing.von_mises(), 235e6, 1);
    EXPECT_NEAR(at(fit.shaft_limit.tresca).shaft_governing.tresca(), 235e6, 1);
    EXPECT_GT(fit.margin_von_mises(), fit.margin_tresca() - 1e-12);
  }
  // Elastic at 42 um for Re 235 and up by Tresca: the limit is 88.1 MPa.
  PressFitParameters p = MakeFit(40, 80, 0, 42, 50, 0.15);
  p.hub.yield_strength = p.shaft.yield_strength = 235e6;
  EXPECT_NEAR(units::ToMpa(CalcPressFit(p)->hub_limit.tresca), 88.125, 1e-3);
  EXPECT_GT(CalcPressFit(p)->margin_tresca(), 1);
}

TEST(PressFit, BrittleHubIsLimitedByItsHoopStress) {
  PressFitParameters p = MakeFit(60, 120, 0, 60, 45, 0.14, 110, 0.28);
  p.hub.tensile_strength = 250e6;
  const PressFit fit = *CalcPressFit(p);
  EXPECT_NEAR(units::ToMpa(fit.pressure), 47.55, 0.005);
  EXPECT_NEAR(units::ToMpa(fit.hub_limit.tresca), 150, 1e-9);
}

// Its stated yield is a proof stress: grey iron breaks.
TEST(PressFit, GreyIronIsBrittleAndKeepsItsSafety) {
  const PressMaterial iron = ToPressMaterial(*FindMaterial("GJL-250")->material);
  EXPECT_EQ(iron.yield_strength, 0);
  PressFitParameters p = MakeFit(60, 120, 0, 60, 45, 0.14, 110, 0.28);
  p.hub = iron;
  const PressFit fit = *CalcPressFit(p);
  EXPECT_TRUE(fit.is_hub_brittle);
  EXPECT_NEAR(units::ToMpa(fit.hub_limit.von_mises), 250 * (1 - 0.25) / (1 + 0.25), 1e-9);
  EXPECT_NEAR(units::ToMpa(CalcLargestPressure(fit)), 150 / kBrittleSafety, 1e-9);
  EXPECT_EQ(IsFracturing(fit), fit.margin_hub() < kBrittleSafety);
  EXPECT_GT(ToPressMaterial(*FindMaterial("S355")->material).yield_strength, 0);
}

// A load that the joint just carries needs the pressure that it has.
TEST(PressFit, RequiredPressureMatchesForceAndTorqueAlone) {
  const PressFitParameters p = MakeFit(70, 140, 0, 84, 60, 0.09, 215);
  const PressFit fit = *CalcPressFit(p);
  EXPECT_NEAR(CalcRequiredPressure(p, fit.push_out_force, 0, 1), fit.pressure, 1e-3);
  EXPECT_NEAR(CalcRequiredPressure(p, 0, fit.torque, 1), fit.pressure, 1e-3);
  // dsoftcon.be: T 800 N m and F 2.5 kN, each times 1.25, with S 1.4 need 34 MPa.
  EXPECT_NEAR(units::ToMpa(CalcRequiredPressure(p, 1.25 * 2500, 1.25 * 800, 1.4)), 33.9, 0.05);
}

// The joint slips the way in which it holds less, whichever that is.
TEST(PressFit, RequiredPressureIsThatOfTheSmallerFriction) {
  PressFitParameters p = MakeFit(70, 140, 0, 84, 60, 0.09, 215);
  for (const auto& [release, turning] : {std::pair(0.07, 0.16), std::pair(0.16, 0.07)}) {
    p.friction_release = release;
    p.friction_torque = turning;
    const double required = CalcRequiredPressure(p, 2500, 800, 1);
    PressFitParameters joint = p;
    joint.interference = *CalcInterferenceFor(required, p);
    const PressFit fit = *CalcPressFit(joint);
    // Friction along and about the axis holds the load's resultant at the joint's surface.
    const double resultant = std::hypot(2500, 800 / 0.035);
    EXPECT_NEAR(std::min(fit.push_out_force, fit.torque / 0.035), resultant, 1e-9 * resultant);
  }
}

TEST(PressFit, RefusesWhatIsNoJointAndNamesIt) {
  const auto message = [](auto change) {
    PressFitParameters p = MakeFit(40, 80, 0, 42, 50, 0.15);
    change(&p);
    const Result<PressFit> fit = CalcPressFit(p);
    return fit ? std::string() : fit.error().message;
  };
  EXPECT_NE(message([](auto* p) { p->hub_diameter = 0.04; }).find("outer diameter"),
            std::string::npos);
  EXPECT_NE(message([](auto* p) { p->shaft_bore = 0.04; }).find("bore"), std::string::npos);
  EXPECT_NE(message([](auto* p) { p->length = 0; }).find("length"), std::string::npos);
  EXPECT_NE(message([](auto* p) { p->interference = std::nan(""); }).find("interference"),
            std::string::npos);
  EXPECT_NE(message([](auto* p) { p->hub.youngs_modulus = -1; }).find("modulus"),
            std::string::npos);
  EXPECT_EQ(message([](auto* p) { p->interference = -1; }), "");
  PressFitParameters loose = MakeFit(40, 80, 0, -5, 50, 0.15);
  EXPECT_EQ(CalcPressFit(loose)->press_in_force, 0);
  EXPECT_EQ(CalcPressFit(loose)->margin_tresca(), std::numeric_limits<double>::infinity());
}

/** A tongue of 12 mm pressed by 20 um between walls of 10 mm and 14 mm, 20 mm deep and 30 mm broad.
 */
PressFitParameters MakeFlatFit() {
  PressFitParameters p = MakeFit(12, 36, 0, 20, 20, 0.15, 70, 0.33);
  p.breadth = 0.03;
  return p;
}

TEST(PressFit, FlatWallsArePressedAsSlabsInPlaneStrain) {
  const PressFit fit = *CalcPressFit(MakeFlatFit());
  const double aluminium = 70e9 / (1 - 0.33 * 0.33);
  const double steel = 210e9 / (1 - 0.3 * 0.3);
  const double pressure = 20e-6 / (0.012 / steel + 0.024 / aluminium);
  EXPECT_NEAR(fit.pressure, pressure, 1e-9 * pressure);
  EXPECT_NEAR(fit.outline, 0.06, 1e-15);
  EXPECT_NEAR(fit.press_in_force, 0.15 * 2 * 0.03 * 0.02 * pressure, 1e-9 * fit.press_in_force);
  EXPECT_EQ(fit.torque, 0);
}

// A slab in compression begins to yield where the pressure is its strength, a wall as the tongue;
// the margin is that of the weaker one.
TEST(PressFit, FlatWallsYieldWhereThePressureIsTheirStrength) {
  PressFitParameters p = MakeFlatFit();
  p.hub.yield_strength = 145e6;
  p.shaft.yield_strength = 235e6;
  for (const double pressure : {100e6, 144e6, 146e6}) {
    p.interference = *CalcInterferenceFor(pressure, p);
    const PressFit fit = *CalcPressFit(p);
    EXPECT_NEAR(fit.margin_von_mises(), 145e6 / pressure, 1e-9);
    EXPECT_NEAR(fit.margin_tresca(), 145e6 / pressure, 1e-9);
    EXPECT_NEAR(fit.margin_shaft(), 235e6 / pressure, 1e-9);
    EXPECT_NEAR(-fit.hub_bore.radial / fit.hub_limit.tresca, pressure / 145e6, 1e-9);
  }
  EXPECT_NEAR(CalcLargestPressure(*CalcPressFit(p)), 145e6, 1);
  // The strength of what has no yield point is its tensile strength, which compression exceeds.
  p.hub.yield_strength = 0;
  p.hub.tensile_strength = 250e6;
  EXPECT_NEAR(CalcPressFit(p)->hub_limit.von_mises, 250e6, 1);
  p.hub.tensile_strength = 0;
  EXPECT_EQ(CalcPressFit(p)->hub_limit.von_mises, std::numeric_limits<double>::infinity());
}

// An independent way to the same pressure: the split of the interference with the least energy.
TEST(PressFit, FlatWallsShareTheInterferenceWithTheLeastEnergy) {
  const PressFitParameters p = MakeFlatFit();
  const double walls = 70e9 / (1 - 0.33 * 0.33) / 0.024;  // [Pa/m]
  const double tongue = 210e9 / (1 - 0.3 * 0.3) / 0.012;
  const auto energy = [&](double x) {
    return walls * (p.interference - x) * (p.interference - x) + tongue * x * x;
  };
  double low = 0;
  double high = p.interference;
  for (int i = 0; i < 200; ++i) {
    const double a = low + (high - low) / 3;
    const double b = high - (high - low) / 3;
    (energy(a) < energy(b) ? high : low) = energy(a) < energy(b) ? b : a;
  }
  const PressFit fit = *CalcPressFit(p);
  EXPECT_NEAR(fit.shaft_contraction, low, 1e-6 * p.interference);
  EXPECT_NEAR(fit.shaft_contraction + fit.hub_expansion, p.interference, 1e-15);
  EXPECT_NEAR(fit.pressure, tongue * low, 1e-6 * fit.pressure);
}

TEST(PressFit, FlatWallsThatAreRigidOrHalfAsFarApartGiveTheLimits) {
  PressFitParameters p = MakeFlatFit();
  p.hub.youngs_modulus = 1e20;
  const double steel = 210e9 / (1 - 0.3 * 0.3);
  EXPECT_NEAR(CalcPressFit(p)->pressure, 20e-6 * steel / 0.012, 10);
  // Sizes and interference scaled together leave the pressure, as in any linear body.
  PressFitParameters small = MakeFlatFit();
  for (double* length : {&small.joint_diameter, &small.hub_diameter, &small.interference}) {
    *length *= 0.5;
  }
  EXPECT_NEAR(CalcPressFit(small)->pressure, CalcPressFit(MakeFlatFit())->pressure, 1);
}

}  // namespace
}  // namespace hvas::fits
