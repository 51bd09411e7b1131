#include "spatial/surface.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "spatial/test/random_pose.h"

namespace hvas::spatial {
namespace {

constexpr double kAngle = 0.4;  // Half angle of the test cone [rad].

// A surface in its own frame (axis z, origin 0) with a parametrisation of it, for brute force, and
// the test for the material's side.
struct Case {
  std::string name;
  Surface surface;
  Vec3 (*point)(double u, double v);  // u, v in [-1, 1].
  bool (*is_inside)(const Vec3& p);   // For outward = +1.
};

Surface Make(SurfaceKind kind, double radius, double second) {
  Surface surface;
  surface.kind = kind;
  surface.radius = radius;
  surface.second = second;
  return surface;
}

double RadiusOf(const Vec3& p) {
  return std::hypot(p.x(), p.y());
}

std::vector<Case> Cases() {
  return {
      {"plane", Make(SurfaceKind::kPlane, 0, 0),
       [](double u, double v) { return Vec3(3 * u, 3 * v, 0); },
       [](const Vec3& p) { return p.z() < 0; }},
      {"cylinder", Make(SurfaceKind::kCylinder, 0.7, 0),
       [](double u, double v) {
         return Vec3(0.7 * std::cos(std::numbers::pi * u), 0.7 * std::sin(std::numbers::pi * u),
                     3 * v);
       },
       [](const Vec3& p) { return RadiusOf(p) < 0.7; }},
      {"cone", Make(SurfaceKind::kCone, 0, kAngle),
       [](double u, double v) {
         const double z = 2 + 2 * v;  // The nappe that is used.
         const double r = z * std::tan(kAngle);
         return Vec3(r * std::cos(std::numbers::pi * u), r * std::sin(std::numbers::pi * u), z);
       },
       [](const Vec3& p) { return RadiusOf(p) < p.z() * std::tan(kAngle); }},
      {"sphere", Make(SurfaceKind::kSphere, 0.9, 0),
       [](double u, double v) {
         const double polar = 0.5 * std::numbers::pi * v;
         return Vec3(0.9 * std::cos(polar) * std::cos(std::numbers::pi * u),
                     0.9 * std::cos(polar) * std::sin(std::numbers::pi * u), 0.9 * std::sin(polar));
       },
       [](const Vec3& p) { return p.norm() < 0.9; }},
      {"torus", Make(SurfaceKind::kTorus, 0.8, 0.25),
       [](double u, double v) {
         const double r = 0.8 + 0.25 * std::cos(std::numbers::pi * v);
         return Vec3(r * std::cos(std::numbers::pi * u), r * std::sin(std::numbers::pi * u),
                     0.25 * std::sin(std::numbers::pi * v));
       },
       [](const Vec3& p) { return std::hypot(RadiusOf(p) - 0.8, p.z()) < 0.25; }},
  };
}

// Smallest distance to the parametrised surface: a grid, then ever smaller grids around the best.
double BruteForceDistance(const Case& c, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  double u_best = 0;
  double v_best = 0;
  double half = 1;
  for (int level = 0; level < 24; ++level) {
    const int n = level == 0 ? 40 : 4;
    const double u_mid = u_best;
    const double v_mid = v_best;
    for (int i = -n; i <= n; ++i) {
      for (int k = -n; k <= n; ++k) {
        const double u = u_mid + half * i / n;
        const double v = v_mid + half * k / n;
        const double distance = (c.point(u, v) - p).norm();
        if (distance < best) {
          best = distance;
          u_best = u;
          v_best = v;
        }
      }
    }
    half = level == 0 ? 2.0 / n : 0.5 * half;
  }
  return best;
}

// Points whose nearest point lies inside the parametrised patch, and off the axis.
bool IsFairPoint(const Case& c, const Vec3& p) {
  if (RadiusOf(p) < 0.05) {
    return false;
  }
  if (c.surface.kind == SurfaceKind::kCone) {
    // Foot on the generator at a positive height.
    return RadiusOf(p) * std::sin(kAngle) + p.z() * std::cos(kAngle) > 0.1;
  }
  return true;
}

TEST(SurfaceDistance, AgreesWithBruteForceOnBothSides) {
  Random random(31);
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    int inside = 0;
    int tested = 0;
    while (tested < 60) {
      const Vec3 on_surface = c.point(random.Uniform(-0.5, 0.5), random.Uniform(-0.5, 0.5));
      const Vec3 p = on_surface + RandomVector(&random, tested % 2 == 0 ? 0.2 : 1.0);
      if (!IsFairPoint(c, p)) {
        continue;
      }
      ++tested;
      inside += c.is_inside(p) ? 1 : 0;
      const double expected = (c.is_inside(p) ? -1 : 1) * BruteForceDistance(c, p);
      Surface surface = c.surface;
      const SurfaceDistance shaft = CalcDistance(surface, p);
      ASSERT_TRUE(shaft.is_valid);
      EXPECT_NEAR(shaft.distance, expected, 1e-6);
      surface.outward = -1;
      const SurfaceDistance hole = CalcDistance(surface, p);
      EXPECT_EQ(hole.distance, -shaft.distance);
      EXPECT_EQ(hole.gradient, Vec3(-shaft.gradient));
    }
    EXPECT_GT(inside, 3) << "the draw must reach both sides";
    EXPECT_LT(inside, 57) << "the draw must reach both sides";
  }
}

TEST(SurfaceDistance, GradientIsTheFiniteDifferenceAndOfUnitLength) {
  Random random(32);
  constexpr double kH = 1e-6;
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    for (int i = 0; i < 200; ++i) {
      const Pose X_AB = RandomPose(&random, 1);
      const Surface surface = Transform(X_AB, c.surface);
      const Vec3 p_B = RandomVector(&random, 1.5);
      if (!IsFairPoint(c, p_B) || std::abs(CalcDistance(c.surface, p_B).distance) > 0.6) {
        continue;
      }
      const Vec3 p = X_AB * p_B;
      Vec3 difference;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = kH * Vec3::Unit(axis);
        difference[axis] =
            (CalcDistance(surface, p + step).distance - CalcDistance(surface, p - step).distance) /
            (2 * kH);
      }
      const SurfaceDistance result = CalcDistance(surface, p);
      EXPECT_LT((result.gradient - difference).norm(), 1e-7);
      EXPECT_NEAR(result.gradient.norm(), 1, 1e-13);
      // Walking back by the distance along the gradient ends on the surface.
      EXPECT_NEAR(CalcDistance(surface, p - result.distance * result.gradient).distance, 0, 1e-13);
    }
  }
}

TEST(SurfaceDistance, DoesNotDependOnTheFrame) {
  Random random(33);
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    for (int i = 0; i < 200; ++i) {
      const Pose X_AB = RandomPose(&random, 3);
      const Vec3 p_B = RandomVector(&random, 1.5);
      if (!IsFairPoint(c, p_B)) {
        continue;
      }
      const SurfaceDistance in_B = CalcDistance(c.surface, p_B);
      const SurfaceDistance in_A = CalcDistance(Transform(X_AB, c.surface), X_AB * p_B);
      ASSERT_EQ(in_A.is_valid, in_B.is_valid);
      EXPECT_NEAR(in_A.distance, in_B.distance, 1e-13);
      EXPECT_LT((in_A.gradient - X_AB.q() * in_B.gradient).norm(), 1e-12);
    }
  }
}

TEST(SurfaceDistance, HasNoGradientOnAnAxisOrAFreeformSurface) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    EXPECT_EQ(CalcDistance(c.surface, Vec3::Zero()).is_valid,
              c.surface.kind == SurfaceKind::kPlane);
  }
  EXPECT_FALSE(CalcDistance(Surface{}, Vec3(1, 2, 3)).is_valid);
}

// Numbers worked out by hand: a shaft of 20 mm and its hole with 10 um of radial clearance.
TEST(SurfaceDistance, OfAShaftAndItsHoleAddUpToTheClearance) {
  Surface shaft = Make(SurfaceKind::kCylinder, 0.01, 0);
  Surface hole = Make(SurfaceKind::kCylinder, 0.01001, 0);
  hole.outward = -1;
  const Vec3 on_shaft(0, 0.01, 0.5);
  EXPECT_NEAR(CalcDistance(shaft, on_shaft).distance, 0, 1e-18);
  EXPECT_NEAR(CalcDistance(hole, on_shaft).distance, 1e-5, 1e-17);
  EXPECT_EQ(CalcDistance(hole, on_shaft).gradient, Vec3(0, -1, 0)) << "out of the material";
}

}  // namespace
}  // namespace hvas::spatial
