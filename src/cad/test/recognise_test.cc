#include "cad/triangles/recognise.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

constexpr double kTolerance = 1e-6;  // [m]

/** Samples of a surface given in its own frame by (u, v) -> point and normal, moved by X. */
std::vector<SurfaceSample> Sample(const spatial::Pose& X,
                                  const std::function<SurfaceSample(double, double)>& at) {
  std::vector<SurfaceSample> samples;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const SurfaceSample sample = at(i / 8.0, j / 8.0);
      samples.push_back({X * sample.p, X.q() * sample.nhat});
    }
  }
  return samples;
}

spatial::Pose RandomPose(Random* random) {
  const Vec3 theta_u(random->Uniform(-2, 2), random->Uniform(-2, 2), random->Uniform(-2, 2));
  const Vec3 p(random->Uniform(-0.3, 0.3), random->Uniform(-0.3, 0.3), random->Uniform(-0.3, 0.3));
  return {spatial::RotationFromVector(theta_u), p};
}

SurfaceSample OnCylinder(double u, double v, double sense) {
  const double angle = 1.2 * u;
  const Vec3 radial(std::cos(angle), std::sin(angle), 0);
  return {0.005 * radial + Vec3(0, 0, 0.02 * v), sense * radial};
}

TEST(RecogniseSurface, FindsHolesAndShaftsInAnyPose) {
  Random random(20250101);
  for (int draw = 0; draw < 200; ++draw) {
    SCOPED_TRACE(draw);
    const double sense = draw % 2 == 0 ? 1 : -1;
    const spatial::Pose X = RandomPose(&random);
    const auto surface = RecogniseSurface(
        Sample(X, [sense](double u, double v) { return OnCylinder(u, v, sense); }), kTolerance);
    ASSERT_TRUE(surface.has_value());
    ASSERT_EQ(surface->kind, SurfaceKind::kCylinder);
    EXPECT_NEAR(surface->radius, 0.005, 1e-11);
    EXPECT_EQ(surface->outward, sense);
    EXPECT_LT(surface->axis.cross(X.q() * Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_LT((surface->origin - X.p()).cross(surface->axis).norm(), 1e-10);
  }
}

TEST(RecogniseSurface, FindsAPlaneAndItsSense) {
  Random random(7);
  const spatial::Pose X = RandomPose(&random);
  const auto surface =
      RecogniseSurface(Sample(X,
                              [](double u, double v) {
                                return SurfaceSample{{0.04 * u, 0.01 * v, 0}, -Vec3::UnitZ()};
                              }),
                       kTolerance);
  ASSERT_TRUE(surface.has_value());
  ASSERT_EQ(surface->kind, SurfaceKind::kPlane);
  EXPECT_LT((surface->axis + X.q() * Vec3::UnitZ()).norm(), 1e-9);
}

TEST(RecogniseSurface, FindsASphere) {
  Random random(8);
  const spatial::Pose X = RandomPose(&random);
  const auto surface = RecogniseSurface(
      Sample(X,
             [](double u, double v) {
               const double a = 2 * u;
               const double b = v - 0.5;
               const Vec3 n(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
               return SurfaceSample{0.012 * n, n};
             }),
      kTolerance);
  ASSERT_TRUE(surface.has_value());
  ASSERT_EQ(surface->kind, SurfaceKind::kSphere);
  EXPECT_NEAR(surface->radius, 0.012, 1e-11);
  EXPECT_LT((surface->origin - X.p()).norm(), 1e-10);
}

TEST(RecogniseSurface, FindsACone) {
  Random random(9);
  const spatial::Pose X = RandomPose(&random);
  const double half = 0.4;
  const auto surface = RecogniseSurface(
      Sample(X,
             [half](double u, double v) {
               const double a = 3 * u;
               const double s = 0.01 + 0.01 * v;  // Along the generator from the apex.
               const Vec3 radial(std::cos(a), std::sin(a), 0);
               return SurfaceSample{s * (std::sin(half) * radial + std::cos(half) * Vec3::UnitZ()),
                                    std::cos(half) * radial - std::sin(half) * Vec3::UnitZ()};
             }),
      kTolerance);
  ASSERT_TRUE(surface.has_value());
  ASSERT_EQ(surface->kind, SurfaceKind::kCone);
  EXPECT_NEAR(surface->second, half, 1e-9);
  EXPECT_LT((surface->origin - X.p()).norm(), 1e-9);
  EXPECT_LT((surface->axis - X.q() * Vec3::UnitZ()).norm(), 1e-9);
}

TEST(RecogniseSurface, FindsATorus) {
  Random random(10);
  const spatial::Pose X = RandomPose(&random);
  const auto surface =
      RecogniseSurface(Sample(X,
                              [](double u, double v) {
                                const double a = 2.5 * u;
                                const double b = 1.4 * v;
                                const Vec3 radial(std::cos(a), std::sin(a), 0);
                                const Vec3 n = std::cos(b) * radial + std::sin(b) * Vec3::UnitZ();
                                return SurfaceSample{0.02 * radial + 0.004 * n, n};
                              }),
                       kTolerance);
  ASSERT_TRUE(surface.has_value());
  ASSERT_EQ(surface->kind, SurfaceKind::kTorus);
  EXPECT_NEAR(surface->radius, 0.02, 1e-9);
  EXPECT_NEAR(surface->second, 0.004, 1e-9);
  EXPECT_LT((surface->origin - X.p()).norm(), 1e-9);
}

TEST(RecogniseSurface, LeavesAnEllipticCylinderAndASaddleAlone) {
  const auto ellipse = Sample({}, [](double u, double v) {
    const double a = 2 * std::numbers::pi * u;
    return SurfaceSample{{0.005 * std::cos(a), 0.00502 * std::sin(a), 0.01 * v},
                         Vec3(std::cos(a) / 0.005, std::sin(a) / 0.00502, 0).normalized()};
  });
  EXPECT_FALSE(RecogniseSurface(ellipse, kTolerance).has_value());
  const auto saddle = Sample({}, [](double u, double v) {
    const double x = 0.02 * (u - 0.5);
    const double y = 0.02 * (v - 0.5);
    return SurfaceSample{{x, y, 20 * x * y}, Vec3(-20 * y, -20 * x, 1).normalized()};
  });
  EXPECT_FALSE(RecogniseSurface(saddle, kTolerance).has_value());
}

TEST(OrientSurface, TurnsAHoleInwardsAndAPlaneOutwards) {
  // One triangle of the plane z = 0 whose normal is -z.
  const std::vector<Vec3> vertices{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  Surface plane;
  plane.kind = SurfaceKind::kPlane;
  EXPECT_NEAR(OrientSurface(vertices, triangles, &plane), 1, 1e-12);
  EXPECT_EQ(plane.axis, Vec3(0, 0, -1));
  Surface cylinder;  // Around an axis below: the triangle faces it, as the wall of a hole does.
  cylinder.kind = SurfaceKind::kCylinder;
  cylinder.origin = {0, 0.25, -100};
  cylinder.axis = Vec3::UnitX();
  cylinder.radius = 100;
  OrientSurface(vertices, triangles, &cylinder);
  EXPECT_EQ(cylinder.outward, -1);
}

}  // namespace
}  // namespace hvas::cad
