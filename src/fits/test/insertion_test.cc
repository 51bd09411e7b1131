#include "fits/insertion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/units.h"

namespace hvas::fits {
namespace {

PegInHole MakePair(double hole_mm, double peg_mm) {
  return {units::FromMm(hole_mm), units::FromMm(peg_mm)};
}

// N5: angles of two-point contact, H7/g6 at its mean and coarser pairs.
TEST(Insertion, TwoPointContactEqualsTheExactPlanarSolution) {
  struct Case {
    double hole_mm, peg_mm, l_mm, tilt, largest_deg, least_mm;
  };

  for (const Case& c : {Case{40.0125, 39.983, 10, 0.002967610279, 2.200277618, 1.536185943},
                        Case{40.0125, 39.983, 50, 5.90139e-4, 2.200277618, 1.536185943},
                        Case{20, 19.9, 10, 0.01010170516, 5.731967965, 1.997498436},
                        Case{20, 19.9, 40, 2.501559e-3, 5.731967965, 1.997498436},
                        Case{10, 9.98, 5, 0.004016107637, 3.624307494, 0.6321392252}}) {
    const PegInHole pair = MakePair(c.hole_mm, c.peg_mm);
    const double l = units::FromMm(c.l_mm);
    EXPECT_NEAR(CalcTwoPointTilt(pair, l), c.tilt, 1e-6 * c.tilt);
    EXPECT_NEAR(units::ToDeg(CalcLargestTilt(pair)), c.largest_deg, 1e-8 * c.largest_deg);
    EXPECT_NEAR(units::ToMm(CalcLeastTwoPointLength(pair)), c.least_mm, 1e-9 * c.least_mm);
  }
  EXPECT_NEAR(units::ToMm(CalcTwoPointLength(MakePair(20, 19.9), units::FromDeg(0.5))), 11.546132,
              1e-6);
}

TEST(Insertion, TwoPointLengthAndTiltAreEachOthersInverse) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double hole = random.Uniform(0.002, 0.2);
    const PegInHole pair{hole, hole * (1 - random.Uniform(1e-5, 1e-2))};
    const double l = CalcLeastTwoPointLength(pair) * random.Uniform(1.01, 50);
    const double tilt = CalcTwoPointTilt(pair, l);
    EXPECT_NEAR(CalcTwoPointLength(pair, tilt), l, 1e-8 * l);
    EXPECT_NEAR(pair.peg_diameter * std::cos(tilt) + l * std::sin(tilt), hole, 1e-12);
  }
  EXPECT_TRUE(std::isnan(CalcTwoPointTilt(MakePair(20, 19.9), 1e-3)));
  EXPECT_TRUE(std::isnan(CalcTwoPointLength(MakePair(20, 19.9), 0.11)));
}

// Independent: the depth at which a tilted disc-ended peg, sampled point by point, meets the hole.
double FindTipDepth(const PegInHole& pair, double tilt) {
  const double hole = 0.5 * pair.hole_diameter;
  const double peg = 0.5 * pair.peg_diameter;
  // Least and greatest x of the peg's part below the rim, its tip's middle at depth h and x = 0.
  const auto width = [&](double h) {
    double left = 0;
    double right = 0;
    constexpr int kSteps = 20000;
    for (int side = -1; side <= 1; side += 2) {
      for (int i = 0; i <= kSteps; ++i) {
        const double s = 4 * hole * i / kSteps / std::max(0.01, std::sin(tilt));
        const double x = side * peg * std::cos(tilt) + s * std::sin(tilt);
        const double z = -h - side * peg * std::sin(tilt) + s * std::cos(tilt);
        if (z <= 0) {
          left = std::min(left, x);
          right = std::max(right, x);
        }
      }
    }
    return right - left;
  };
  double low = 0;
  double high = 20 * hole;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (width(middle) > 2 * hole ? high : low) = middle;
  }
  return low;
}

TEST(Insertion, TipDepthEqualsTheFormulaAndASampledPeg) {
  struct Case {
    double peg_mm, tilt_deg, depth_mm;
  };

  for (const Case& c :
       {Case{19.9, 1, 5.728982938}, Case{19.9, 4, 1.429220227}, Case{19.4, 8, 4.262620761}}) {
    const PegInHole pair = MakePair(20, c.peg_mm);
    const double tilt = units::FromDeg(c.tilt_deg);
    EXPECT_NEAR(units::ToMm(CalcTipDepth(pair, tilt)), c.depth_mm, 1e-8 * c.depth_mm);
    EXPECT_NEAR(FindTipDepth(pair, tilt), CalcTipDepth(pair, tilt), 0.02 * 1e-3 * c.depth_mm);
  }
}

TEST(Insertion, JammingDiagramAndVerdictsEqualTheWorkedCases) {
  EXPECT_NEAR(CalcLambda(0.05, 0.02, 0.15), 8.333333333, 1e-8);
  const auto corners = CalcJammingDiagram(CalcLambda(0.05, 0.02, 0.15), 0.15);
  EXPECT_NEAR(corners[0].f_x_over_f_z, 6.66667, 1e-5);
  EXPECT_NEAR(corners[1].m_over_r_f_z, 17.6667, 1e-4);
  EXPECT_NEAR(corners[3].m_over_r_f_z, -17.6667, 1e-4);

  const auto slides = [](double f_x, double m_over_r) {
    return IsSliding({f_x, 1, m_over_r * 0.01}, 0.02, 0.01, 0.3);
  };
  EXPECT_TRUE(slides(0, 3.0));
  EXPECT_FALSE(slides(0, 3.6));
  EXPECT_TRUE(slides(2, -1));
  EXPECT_FALSE(slides(2, 1));
  EXPECT_FALSE(IsSliding({0, -1, 0}, 0.02, 0.01, 0.3));

  const PegLoad load = CalcTwoPointLoad(3, 5, 0.02, 0.01, 0.3);
  EXPECT_NEAR(load.f_x, -2, 1e-12);
  EXPECT_NEAR(load.f_z, 2.4, 1e-12);
  EXPECT_NEAR(load.m, 0.106, 1e-12);
  EXPECT_NEAR(load.m / (0.01 * load.f_z), 4.416666667, 1e-9);
}

using Ray = std::array<double, 3>;  // F_x, F_z, M / r of a contact's force on the peg.

/** Whether non-negative multiples of the rays add up to `need`: a linear programme of three rows,
 solved by enumeration. Caratheodory: in the cone of three of the rays, or in none. */
bool IsInCone(const std::array<Ray, 4>& rays, const Ray& need) {
  const auto determinant = [](const Ray& a, const Ray& b, const Ray& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  for (std::size_t skip = 0; skip < 4; ++skip) {
    const Ray& r0 = rays[skip == 0 ? 1 : 0];
    const Ray& r1 = rays[skip <= 1 ? 2 : 1];
    const Ray& r2 = rays[skip <= 2 ? 3 : 2];
    const double d = determinant(r0, r1, r2);
    if (std::abs(d) > 1e-14 && determinant(need, r1, r2) / d >= 0 &&
        determinant(r0, need, r2) / d >= 0 && determinant(r0, r1, need) / d >= 0) {
      return true;
    }
  }
  return false;
}

/** Whether contacts can balance a load on a peg that is tilted one way: its corner touches on one
 side, and the rim on the other (two points) or the same (a line). */
bool CanStay(const PegLoad& load, double l, double radius, double friction) {
  const double mu = friction;
  const double k = l / radius;
  const Ray corner_up{-1, mu, -mu};
  const Ray corner_down{-1, -mu, mu};
  const Ray need{-load.f_x, -load.f_z, -load.m / radius};
  return IsInCone({corner_up, corner_down, Ray{1, mu, -k + mu}, Ray{1, -mu, -k - mu}}, need) ||
         IsInCone({corner_up, corner_down, Ray{-1, mu, k - mu}, Ray{-1, -mu, k + mu}}, need);
}

// N5: for lambda > 1 (no wedging) a load slides exactly if no contact forces, with the peg tilted
// either way, can balance it.
TEST(Insertion, VerdictsEqualALinearProgrammeOfTheFrictionCones) {
  Random random(11);
  int sliding = 0;
  for (int i = 0; i < 10000; ++i) {
    const double radius = random.Uniform(0.002, 0.05);
    const double friction = random.Uniform(0.05, 0.5);
    const double l = 2 * radius * friction * random.Uniform(1.02, 12);
    const double lambda = CalcLambda(l, radius, friction);
    const PegLoad load{random.Uniform(-1.3, 1.3) / friction, 1,
                       radius * random.Uniform(-1, 1) * (1 + 2.5 * lambda)};
    const PegLoad mirrored{-load.f_x, load.f_z, -load.m};
    const bool stays = CanStay(load, l, radius, friction) || CanStay(mirrored, l, radius, friction);
    EXPECT_EQ(IsSliding(load, l, radius, friction), !stays)
        << load.f_x << " " << load.m / radius << " lambda " << lambda << " mu " << friction;
    sliding += stays ? 0 : 1;
  }
  EXPECT_GT(sliding, 1000);
  EXPECT_LT(sliding, 9000);
}

// Wedging: below l = mu d opposite forces along the line between the contacts lie in both cones.
TEST(Insertion, WedgesExactlyWhereTheFrictionConesSeeEachOther) {
  const PegInHole pair{0.02, 0.02};
  EXPECT_TRUE(CanWedge(pair, 5.999e-3, 0.3));
  EXPECT_FALSE(CanWedge(pair, 6.001e-3, 0.3));
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const double d = random.Uniform(0.002, 0.1);
    const double friction = random.Uniform(0.05, 0.5);
    const double l = d * friction * random.Uniform(0.2, 2);
    const bool cones_meet = l / d <= friction;  // The line's slope is within both cones.
    EXPECT_EQ(CanWedge({d, d}, l, friction), cones_meet);
  }
  // Paper W's H7/g6 at its mean: mu d = 6 mm, and c / mu = 0.2816 degrees to first order in c.
  const PegInHole g6 = MakePair(40.0125, 39.983);
  EXPECT_NEAR(units::ToDeg(CalcWedgingTilt(g6, 0.15)) / 0.2816, 1, 0.02);
  EXPECT_NEAR(CalcTwoPointLength(g6, CalcWedgingTilt(g6, 0.15)), 0.15 * 0.039983, 1e-12);
}

TEST(Insertion, ForcesOnACompliantSupportEqualTheWorkedCases) {
  struct Chamfer {
    CompliantSupport support;
    double radius, friction, angle_deg, descent, f_z, f_x;
  };

  for (const Chamfer& c :
       {Chamfer{{10e3, 50, 0.05}, 0.01, 0.15, 45, 1e-3, 9.913793103, 7.327586207},
        Chamfer{{20e3, 20, 0}, 0.01, 0.2, 30, 0.5e-3, 51.200462, 17.320508},
        Chamfer{{5e3, 100, 0.08}, 0.02, 0.1, 60, 2e-3, 3.287388931, 4.573101368}}) {
    const InsertionForce f =
        CalcChamferForce(c.support, c.radius, c.friction, units::FromDeg(c.angle_deg), c.descent);
    EXPECT_NEAR(f.f_z, c.f_z, 1e-7 * c.f_z);
    EXPECT_NEAR(f.f_x, c.f_x, 1e-7 * c.f_x);
  }
  const InsertionForce one = CalcOnePointForce({10e3, 50, 0.05}, 0.01, 0.15, 0.5e-3, 0.01, 0.01);
  EXPECT_NEAR(one.normal, 4.587155963, 1e-8);
  EXPECT_NEAR(one.f_z, 0.6880733945, 1e-9);
  const InsertionForce two = CalcOnePointForce({20e3, 20, 0}, 0.01, 0.2, 0.3e-3, 0.005, 0.005);
  EXPECT_NEAR(two.normal, 6.280193, 1e-6);
  EXPECT_NEAR(two.f_z, 1.256039, 1e-6);
  // A chamfer flatter than the friction angle holds the peg.
  EXPECT_TRUE(std::isnan(CalcChamferForce({10e3, 50, 0.05}, 0.01, 0.5, 0.4, 1e-3).f_z));
}

TEST(Insertion, EntryWindowIsTheClearanceAndBothChamfers) {
  EXPECT_NEAR(CalcEntryWindow(MakePair(20, 19.9), 0, 0), 50e-6, 1e-15);
  EXPECT_NEAR(CalcEntryWindow(MakePair(20, 19.9), 1e-3, 0.5e-3), 1.55e-3, 1e-15);
}

}  // namespace
}  // namespace hvas::fits
