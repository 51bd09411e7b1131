// How parts that give are drawn: closed forms.

#include "simulation/deformation.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace hvas::simulation {
namespace {

constexpr double kTiny = 1e-15;  // [m]

DeformationForm FormOf(DeformationKind kind) {
  DeformationForm form;
  form.kind = kind;
  form.origin_B = Vec3(1e-3, -2e-3, 3e-3);
  form.axis_B = Vec3(1, 2, 2) / 3;
  form.aside_B = Vec3(2, 1, -2) / 3;
  form.length = 20e-3;
  form.range = {-3e-3, 3e-3};
  form.across = {-6e-3, 6e-3};
  return form;
}

/** A point by its distances from the origin along the axis, aside and across. */
Vec3 PointAt(const DeformationForm& form, double along, double aside, double across) {
  return form.origin_B + along * form.axis_B + aside * form.aside_B +
         across * form.axis_B.cross(form.aside_B);
}

Vec3 PointAround(const DeformationForm& form, double along, double radius, double angle) {
  return PointAt(form, along, radius * std::cos(angle), radius * std::sin(angle));
}

TEST(Deformation, WithoutAnAmountEveryPointStaysToTheBit) {
  for (int kind = 0; kind <= static_cast<int>(DeformationKind::kShift); ++kind) {
    const DeformationForm form = FormOf(static_cast<DeformationKind>(kind));
    for (const Vec3& p : {Vec3(0.1, 0.2, 0.3), PointAt(form, 10e-3, 1e-3, 2e-3)}) {
      EXPECT_EQ(Deform(form, 0, p), p) << ToString(form.kind);
    }
  }
}

// y (3 x^2 l - x^3) / (2 l^3): 5/16 of the tip's at the middle; straight on beyond the tip, by 3 y
// / (2 l).
TEST(Deformation, AnArmBendsAsACantileverFromItsRoot) {
  const DeformationForm form = FormOf(DeformationKind::kBend);
  constexpr double kY = 0.9e-3;
  const auto aside = [&](double x) {
    const Vec3 p = PointAt(form, x, 1e-3, -2e-3);
    return (Deform(form, kY, p) - p).dot(form.aside_B);
  };
  EXPECT_EQ(aside(0), 0);
  EXPECT_EQ(aside(-1e-3), 0);
  EXPECT_NEAR(aside(20e-3), kY, kTiny);
  EXPECT_NEAR(aside(10e-3), kY * 5 / 16, kTiny);
  EXPECT_NEAR(aside(22e-3), kY * 1.15, kTiny);
  // The slope at the root is 0, and at the tip it is that of the line beyond.
  EXPECT_LT(aside(1e-6), 1e-11);
  EXPECT_NEAR((aside(20e-3) - aside(20e-3 - 1e-6)) / 1e-6, 1.5 * kY / 20e-3, 1e-5);
  // Beside the arm nothing moves.
  for (const Vec3& p : {PointAt(form, 10e-3, 4e-3, 0), PointAt(form, 10e-3, 0, 7e-3)}) {
    EXPECT_EQ(Deform(form, kY, p), p);
  }
}

TEST(Deformation, AWallAllAroundBendsAlongItsRadius) {
  DeformationForm form = FormOf(DeformationKind::kFlare);
  form.range = {9e-3, 10e-3};
  for (const double sign : {1.0, -1.0}) {
    form.shares = {sign, 0};
    const Vec3 p = PointAround(form, 20e-3, 9.5e-3, 2);
    const Vec3 expected = PointAround(form, 20e-3, 9.5e-3 + sign * 0.3e-3, 2);
    EXPECT_LT((Deform(form, 0.3e-3, p) - expected).norm(), kTiny);
  }
  const Vec3 root = PointAround(form, 0, 9.5e-3, 2);
  EXPECT_LT((Deform(form, 0.3e-3, root) - root).norm(), kTiny);
}

TEST(Deformation, AClosedRingGetsWiderAllAroundOrFlatter) {
  DeformationForm form = FormOf(DeformationKind::kRadial);
  form.range = {8e-3, 10e-3};
  const auto radius = [&](double amount, double r) {
    const Vec3 d = Deform(form, amount, PointAround(form, 1e-3, r, 0.7)) - form.origin_B;
    EXPECT_NEAR(d.dot(form.axis_B), 1e-3, kTiny);
    return d.cross(form.axis_B).norm();
  };
  for (const double r : {8e-3, 9e-3, 10e-3}) {
    EXPECT_NEAR(radius(0.5e-3, r), r + 0.5e-3, kTiny);
  }
  form.shares = {0, -1};  // Squeezed from outside.
  EXPECT_NEAR(radius(0.4e-3, 8e-3), 8e-3, kTiny);
  EXPECT_NEAR(radius(0.4e-3, 9e-3), 8.8e-3, kTiny);
  EXPECT_NEAR(radius(0.4e-3, 10e-3), 9.6e-3, kTiny);
}

// The middle line keeps its length, so the gap opens by 2 pi y.
TEST(Deformation, AnOpenRingStaysRoundAndAsLongAsItWas) {
  DeformationForm form = FormOf(DeformationKind::kOpen);
  form.length = 9e-3;
  constexpr double kY = 0.4e-3;
  constexpr int kSteps = 4000;  // Of chords, which are shorter than their arcs.
  const double end = 165 * std::numbers::pi / 180;
  double length = 0;
  double mean = 0;
  std::vector<Vec3> points;
  for (int i = 0; i <= kSteps; ++i) {
    points.push_back(
        Deform(form, kY, PointAround(form, 0, form.length, end * (2.0 * i / kSteps - 1))));
    mean += (points.back() - form.origin_B).norm() / (kSteps + 1);
    length += i > 0 ? (points[points.size() - 1] - points[points.size() - 2]).norm() : 0;
  }
  EXPECT_NEAR(mean, form.length + kY, 1e-12);
  EXPECT_NEAR(length, 2 * end * form.length, 1e-6 * length);
  const double before = 2 * (std::numbers::pi - end) * form.length;
  const double after = 2 * std::numbers::pi * (form.length + kY) - length;
  EXPECT_NEAR(after - before, 2 * std::numbers::pi * kY, 1e-7);
  // The back goes straight out.
  const Vec3 back = Deform(form, kY, PointAround(form, 0, form.length, 0));
  EXPECT_LT((back - PointAround(form, 0, form.length + kY, 0)).norm(), kTiny);
}

TEST(Deformation, ASpringGetsShorterBetweenItsEnds) {
  const DeformationForm form = FormOf(DeformationKind::kPress);
  const auto along = [&](double x) {
    return (Deform(form, -5e-3, PointAt(form, x, 4e-3, 1e-3)) - form.origin_B).dot(form.axis_B);
  };
  EXPECT_NEAR(along(0), 0, kTiny);
  EXPECT_NEAR(along(20e-3), 15e-3, kTiny);
  EXPECT_NEAR(along(10e-3), 7.5e-3, kTiny);
}

TEST(Deformation, ADiscRisesAtOneEdgeAndALockWasherAtOneEnd) {
  DeformationForm disc = FormOf(DeformationKind::kCone);
  disc.range = {5e-3, 10e-3};
  disc.shares = {1, 0};
  const auto rise = [&](const DeformationForm& form, double r, double angle) {
    const Vec3 p = PointAround(form, 0, r, angle);
    return (Deform(form, 1e-3, p) - p).dot(form.axis_B);
  };
  EXPECT_NEAR(rise(disc, 5e-3, 1), 1e-3, kTiny);
  EXPECT_NEAR(rise(disc, 10e-3, 1), 0, kTiny);
  EXPECT_NEAR(rise(disc, 7.5e-3, 1), 0.5e-3, kTiny);
  DeformationForm washer = FormOf(DeformationKind::kHelix);
  EXPECT_NEAR(rise(washer, 5e-3, 0), 0.5e-3, kTiny);
  EXPECT_NEAR(rise(washer, 5e-3, 0.9 * std::numbers::pi), 0.95e-3, kTiny);
  EXPECT_NEAR(rise(washer, 5e-3, -0.9 * std::numbers::pi), 0.05e-3, kTiny);
}

}  // namespace
}  // namespace hvas::simulation
