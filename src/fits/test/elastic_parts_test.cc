// Parts that give elastically, against published examples, integrals and energies.

#include "fits/elastic_parts.h"

#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

constexpr double kMm = 1e-3;

// Bayer MaterialScience, Snap-Fit Joints for Plastics, calculation example: a hook of polycarbonate
// that tapers to half: h 3.28 mm, P 32.5 N, W 58.5 N at mu 0.6 and 30 degrees.
TEST(SnapArm, IsThatOfThePublishedExample) {
  const double strain = 0.02;
  const double undercut = 2.4 * kMm;
  SnapArm arm{19 * kMm, 9.5 * kMm, 1.0, 1815e6, true};
  arm.thickness = CalcArmDeflection(arm, strain) / undercut;  // y h is the same for each h.
  EXPECT_NEAR(arm.thickness, 3.279 * kMm, 0.001 * kMm);
  EXPECT_NEAR(CalcArmDeflection(arm, strain), undercut, 1e-12);
  const double across = CalcArmStiffness(arm) * undercut;
  EXPECT_NEAR(across, 32.53, 0.01);
  const double slope = std::tan(30 * std::numbers::pi / 180);
  EXPECT_NEAR(across * CalcSlidingRatio(0.6, slope), 58.59, 0.01);
}

// A cantilever of constant section has 3 E I / l^3; Bayer's 0.67 is two thirds.
TEST(SnapArm, OfConstantSectionIsACantilever) {
  const SnapArm arm{20 * kMm, 6 * kMm, 2 * kMm, 2e9};
  const double inertia = arm.width * std::pow(arm.thickness, 3) / 12;
  const double exact = 3 * arm.modulus * inertia / std::pow(arm.length, 3);
  EXPECT_NEAR(CalcArmStiffness(arm), exact, 0.006 * exact);
}

// BASF's example of a hook with the same friction and angle: 7.31 lbf across, 13.17 lbf along.
TEST(SlidingRatio, IsThatOfPublishedPairs) {
  EXPECT_NEAR(CalcSlidingRatio(0.6, std::tan(std::numbers::pi / 6)), 13.17 / 7.31, 1e-3);
  EXPECT_DOUBLE_EQ(CalcSlidingRatio(0, 0.5), 0.5);
  EXPECT_DOUBLE_EQ(CalcSlidingRatio(0.3, -0.3), 0);
  EXPECT_TRUE(std::isinf(CalcSlidingRatio(0.5, 2)));
}

// Green and English (1994) after Lindley: 318.8 N for d 3.53, D 50 mm, 5 MPa, 20 %.
TEST(ORing, IsSqueezedByThePublishedForce) {
  const ORing ring{50 * kMm, 3.53 * kMm, 5e6};
  EXPECT_NEAR(CalcSqueezeForce(ring, 0.2 * ring.section), 318.8, 0.1);
  EXPECT_NEAR(CalcSqueezeForce(ring, 0.1 * ring.section), 109.73, 0.01);
  EXPECT_NEAR(CalcSqueezeForce({20 * kMm, 2.62 * kMm, 5e6}, 0.2 * 2.62 * kMm), 94.659, 0.001);
  EXPECT_EQ(CalcSqueezeForce(ring, 0), 0);
  EXPECT_EQ(CalcSqueezeForce(ring, -1e-3), 0);
}

TEST(ORing, HasTheSlopeOfItsForce) {
  const ORing ring{50 * kMm, 3.53 * kMm, 5e6};
  constexpr double kStep = 1e-8;
  for (const double share : {0.05, 0.2, 0.4, 0.49, 0.6}) {
    const double y = share * ring.section;
    const double slope =
        (CalcSqueezeForce(ring, y + kStep) - CalcSqueezeForce(ring, y - kStep)) / (2 * kStep);
    EXPECT_NEAR(CalcSqueezeStiffness(ring, y), slope, 1e-4 * slope) << share;
  }
}

// Hoop tension times the growth of the circumference is the force times that of the radius.
TEST(ORing, IsStretchedByItsHoopTension) {
  const ORing ring{20 * kMm, 2 * kMm, 5e6};
  const double growth = 0.1 * kMm;
  const double area = std::numbers::pi * kMm * kMm;
  const double tension = ring.modulus * area * growth / (10 * kMm);
  const double work = tension * 2 * std::numbers::pi * growth;
  EXPECT_NEAR(CalcStretchStiffness(ring) * growth * growth, work, 1e-9 * work);
}

// The work of the bending moments p b r^2 (1 + cos phi) of a curved beam, summed up.
TEST(OpenRing, OpensAsTheSumOfItsBendingMoments) {
  const OpenRing ring{10 * kMm, 2.6 * kMm, 1.2 * kMm, 210e9};
  const double inertia = ring.thickness * std::pow(ring.width, 3) / 12;
  const double pressure = 1e3;  // Along the circumference [N/m].
  double gap = 0;
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = std::numbers::pi * ((2 * i + 1.0) / kSteps - 1);
    const double moment = pressure * ring.radius * ring.radius * (1 + std::cos(phi));
    gap += moment * ring.radius * (1 + std::cos(phi)) / (ring.modulus * inertia) * ring.radius * 2 *
           std::numbers::pi / kSteps;
  }
  const double growth = gap / (2 * std::numbers::pi);
  const double force = 2 * std::numbers::pi * ring.radius * pressure;
  EXPECT_NEAR(CalcSpreadStiffness(ring), force / growth, 1e-6 * force / growth);
}

// A pin of ISO 8752, 4 mm, closed by 0.01 mm bends elastically; by its 0.25 mm its back yields,
// where the moments of the pressure, summed up from the slit on, are the plastic moment.
TEST(SlitPin, YieldsAtItsBackWhereItsHoleClosesIt) {
  const SlitPin pin{4.5 * kMm, 0.8 * kMm, 20 * kMm, 206e9, 1.4e9};
  const double r = 1.85 * kMm;
  EXPECT_NEAR(CalcSlitPinForce(pin, 0.01 * kMm),
              CalcSpreadStiffness({r, pin.wall, pin.length, pin.modulus}) * 0.01 * kMm, 1e-6);
  const double force = CalcSlitPinForce(pin, 0.25 * kMm);
  const double line = force / (2 * std::numbers::pi * r);  // Along the circumference [N/m].
  double moment = 0;
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = std::numbers::pi * (i + 0.5) / kSteps;  // From the slit to the back.
    moment += line * r * r * std::sin(phi) * std::numbers::pi / kSteps;
  }
  const double plastic = pin.yield * pin.length * pin.wall * pin.wall / 4;
  EXPECT_NEAR(moment, plastic, 1e-6 * plastic);
  EXPECT_EQ(CalcSlitPinForce(pin, -1), 0);
}

// A thin and long sleeve is a wall between plates; its bulk limits it, and sliding along it shears
// it.
TEST(RubberSleeve, IsAWallOfRubberBetweenPlates) {
  const RubberSleeve sleeve{10 * kMm, 14 * kMm, 20 * kMm, 5e6};
  const double wall = 4 * kMm;
  const double shape = 20.0 / 8.0;
  const double area = 2 * std::numbers::pi * 12 * kMm * 20 * kMm;
  const double block = 4.0 / 3.0 * 5e6 * (1 + shape * shape) * area / wall;
  EXPECT_LT(CalcSleeveStiffness(sleeve), block);
  EXPECT_NEAR(CalcSleeveStiffness(sleeve), block, 0.03 * block);
  // Shear stress F / (2 pi r L) over G, summed up from the inside outwards.
  double way = 0;
  constexpr int kSteps = 10'000;
  for (int i = 0; i < kSteps; ++i) {
    const double r = 10 * kMm + wall * (i + 0.5) / kSteps;
    way += 1 / (2 * std::numbers::pi * r * 20 * kMm) / (5e6 / 3) * wall / kSteps;
  }
  EXPECT_NEAR(CalcSleeveShearStiffness(sleeve), 1 / way, 1e-6 / way);
  // Free on one side, it is a ring under hoop tension, and much softer.
  EXPECT_LT(CalcSleeveHoopStiffness(sleeve), 0.2 * CalcSleeveStiffness(sleeve));
  const double growth = 0.1 * kMm;
  const double tension = 5e6 * 20 * kMm * wall * growth / (12 * kMm);
  EXPECT_NEAR(CalcSleeveHoopStiffness(sleeve) * growth, 2 * std::numbers::pi * tension,
              1e-9 * tension);
}

/** Stiffness of a lip by shooting: the fourth derivative of w is -k / D w from the root, where w
 and its slope are 0, to the edge, where the moment is 0; by Runge and Kutta's steps. */
double ShootLip(const SealLip& lip) {
  const double t = lip.thickness;
  const double bending = lip.modulus * t * t * t / (12 * 0.75);
  const double foundation = lip.modulus * t / (lip.radius * lip.radius);
  using State = std::array<double, 4>;  // w and its first three derivatives.
  const auto slope = [&](const State& s) {
    return State{s[1], s[2], s[3], -foundation / bending * s[0]};
  };
  const auto add = [](const State& s, const State& d, double by) {
    State out = s;
    for (std::size_t i = 0; i < 4; ++i) {
      out[i] += by * d[i];
    }
    return out;
  };
  const auto shoot = [&](State y) {
    constexpr int kSteps = 4'000;
    const double h = lip.length / kSteps;
    for (int step = 0; step < kSteps; ++step) {
      const State a = slope(y);
      const State b = slope(add(y, a, h / 2));
      const State c = slope(add(y, b, h / 2));
      const State d = slope(add(y, c, h));
      for (std::size_t i = 0; i < 4; ++i) {
        y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
      }
    }
    return y;
  };
  const State moment = shoot({0, 0, 1, 0});
  const State shear = shoot({0, 0, 0, 1});
  const double share = -moment[2] / shear[2];  // No moment at the edge.
  const double w = moment[0] + share * shear[0];
  const double load = -bending * (moment[3] + share * shear[3]);
  return 2 * std::numbers::pi * lip.radius * load / w;
}

TEST(SealLip, IsAShortShellHeldAtItsRoot) {
  for (const SealLip& lip :
       {SealLip{10 * kMm, 4 * kMm, 1 * kMm, 5e6}, SealLip{25 * kMm, 5 * kMm, 0.8 * kMm, 8e6},
        SealLip{4 * kMm, 3 * kMm, 0.5 * kMm, 5e6}}) {
    const double shot = ShootLip(lip);
    EXPECT_NEAR(CalcLipStiffness(lip), shot, 1e-6 * shot);
  }
  // Strips of a very short one, and a tube without an end.
  const double bending = 5e6 * std::pow(1 * kMm, 3) / 9;
  const double strips = 2 * std::numbers::pi * 3 * bending / std::pow(4 * kMm, 3);
  EXPECT_NEAR(CalcLipStiffness({1.0, 4 * kMm, 1 * kMm, 5e6}), strips, 1e-3 * strips);
  const double foundation = 5e6 * 1 * kMm / (10 * kMm * 10 * kMm);
  const double beta = std::pow(foundation / (4 * bending), 0.25);
  const double tube = 2 * std::numbers::pi * 10 * kMm * foundation / (2 * beta);
  EXPECT_NEAR(CalcLipStiffness({10 * kMm, 1.0, 1 * kMm, 5e6}), tube, 1e-12 * tube);
}

}  // namespace
}  // namespace hvas::fits
