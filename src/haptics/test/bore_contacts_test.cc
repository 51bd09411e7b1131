#include "haptics/bore_contacts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <gtest/gtest.h>

#include "base/random.h"
#include "fits/insertion.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;

constexpr double kHoleRadius = 5.2e-3;
constexpr double kShaftRadius = 5e-3;
constexpr double kDepth = 30e-3;  // Of the hole: z from -30 mm to its mouth at 0.
constexpr double kAll = 1;        // [m]: a margin that leaves nothing out.

Bore MakeBore() {
  Bore bore;
  bore.hole_radius = kHoleRadius;
  bore.shaft_radius = kShaftRadius;
  bore.hole_low = -kDepth;
  bore.shaft_high = 60e-3;
  return bore;
}

double DistanceToAxis(const Vec3& p_WC, const Pose& X_WA) {
  const Vec3 p_AC = X_WA.Inverse() * p_WC;
  return std::hypot(p_AC.x(), p_AC.y());
}

/** The least gap of an edge, from points along it: the end of the shaft to the hole's wall, or the
 mouth of the hole to the shaft. */
double SampleGap(const Bore& bore, const Pose& X_WH, const Pose& X_WS, bool is_mouth) {
  constexpr int kPoints = 200000;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Vec3 u(std::cos(angle), std::sin(angle), 0);
    least = std::min(
        least, is_mouth ? DistanceToAxis(X_WH * (bore.hole_radius * u), X_WS) - bore.shaft_radius
                        : bore.hole_radius - DistanceToAxis(X_WS * (bore.shaft_radius * u), X_WH));
  }
  return least;
}

TEST(BoreContactsTest, UprightOnTheAxisThePlayIsTheSameAllRound) {
  BoreContacts contacts;
  const std::size_t count =
      CalcBoreContacts(MakeBore(), Pose(), Pose(Vec3(0, 0, -10e-3)), kAll, &contacts);
  ASSERT_EQ(count, 2 * kBoreDirections);  // The shaft's end in the hole, and the hole's mouth.
  for (const BoreContact& contact : std::span(contacts.data(), count)) {
    EXPECT_NEAR(contact.distance, kHoleRadius - kShaftRadius, 1e-15);
    EXPECT_NEAR(contact.nhat_W.dot(contact.p_WC), -std::hypot(contact.p_WC.x(), contact.p_WC.y()),
                1e-15);
  }
}

// D = d cos t + l sin t, and the depths that the reference states for these radii.
TEST(BoreContactsTest, TouchesAtTwoPointsWhereTheClosedFormSays) {  // N5
  const fits::PegInHole pair{2 * kHoleRadius, 2 * kShaftRadius};
  for (const auto& [degrees, depth_mm] :
       {std::pair(1.0, 22.9160), std::pair(3.0, 7.6323), std::pair(6.0, 3.8043)}) {
    SCOPED_TRACE(degrees);
    const double t = degrees * std::numbers::pi / 180;
    const double l = fits::CalcTwoPointLength(pair, t);
    EXPECT_NEAR(fits::CalcTipDepth(pair, t), 1e-3 * depth_mm, 0.1e-6);
    // The tip's corner on the wall at -x, and the other side on the mouth at +x.
    const Quat q = spatial::RotationFromVector(Vec3(0, t, 0));
    const Vec3 p_WCorner(-kHoleRadius, 0, -(l * std::cos(t) - 2 * kShaftRadius * std::sin(t)));
    const Pose X_WS(q, p_WCorner - q * Vec3(-kShaftRadius, 0, 0));
    EXPECT_NEAR(-X_WS.p().z(), fits::CalcTipDepth(pair, t), 1e-15);
    BoreContacts contacts;
    const std::size_t count = CalcBoreContacts(MakeBore(), Pose(), X_WS, 1e-9, &contacts);
    ASSERT_EQ(count, 2u);
    EXPECT_NEAR(contacts[0].distance, 0, 1e-15);
    EXPECT_LT((contacts[0].p_WC - p_WCorner).norm(), 1e-9);
    EXPECT_LT((contacts[0].nhat_W - Vec3::UnitX()).norm(), 1e-6);
    EXPECT_NEAR(contacts[1].distance, 0, 1e-15);
    EXPECT_LT((contacts[1].p_WC - Vec3(kHoleRadius, 0, 0)).norm(), 1e-9);
    EXPECT_LT((contacts[1].nhat_W + q * Vec3::UnitX()).norm(), 1e-6);
  }
}

// Each of two points lies in the friction cone of the other from the tilt on that the reference
// states for these radii; the small angles of Whitney, c / mu, give 7.35 and 3.67 degrees.
TEST(BoreContactsTest, TwoPointsSeeEachOtherFromTheTiltOfTheExactConesOn) {  // N5
  const fits::PegInHole pair{2 * kHoleRadius, 2 * kShaftRadius};
  for (const auto& [friction, onset_deg] : {std::pair(0.3, 11.66), std::pair(0.6, 4.06)}) {
    SCOPED_TRACE(friction);
    double low = 1 * std::numbers::pi / 180;
    double high = 15 * std::numbers::pi / 180;
    for (int i = 0; i < 50; ++i) {
      const double t = 0.5 * (low + high);
      const Quat q = spatial::RotationFromVector(Vec3(0, t, 0));
      const double l = fits::CalcTwoPointLength(pair, t);
      const Pose X_WS(q, Vec3(kHoleRadius, 0, 0) - q * Vec3(kShaftRadius, 0, l));
      BoreContacts contacts;
      ASSERT_EQ(CalcBoreContacts(MakeBore(), Pose(), X_WS, 1e-9, &contacts), 2u);
      const Vec3 line = (contacts[1].p_WC - contacts[0].p_WC).normalized();
      const double cosine = std::min(contacts[0].nhat_W.dot(line), contacts[1].nhat_W.dot(-line));
      (std::acos(cosine) <= std::atan(friction) ? high : low) = t;
    }
    EXPECT_NEAR(low * 180 / std::numbers::pi, onset_deg, 0.02);
    EXPECT_NEAR(low, fits::CalcWedgingTilt(pair, friction), 1e-6);
  }
}

TEST(BoreContactsTest, TheLeastGapsAreThoseOfDenseSamples) {
  Random random(7);
  const Bore bore = MakeBore();
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const auto draw = [&random](double size) { return size * (2 * random.Uniform() - 1); };
    const Pose X_WH(spatial::RotationFromVector(Vec3(draw(1), draw(1), draw(1))),
                    Vec3(draw(1), draw(1), draw(1)));
    const Pose X_HS(spatial::RotationFromVector(Vec3(draw(0.05), draw(0.05), draw(3))),
                    Vec3(draw(0.2e-3), draw(0.2e-3), -10e-3));
    const Pose X_WS = X_WH * X_HS;
    BoreContacts contacts;
    const std::size_t count = CalcBoreContacts(bore, X_WH, X_WS, kAll, &contacts);
    ASSERT_EQ(count, 2 * kBoreDirections);
    EXPECT_NEAR(contacts[0].distance, SampleGap(bore, X_WH, X_WS, false), 1e-11);
    EXPECT_NEAR(contacts[kBoreDirections].distance, SampleGap(bore, X_WH, X_WS, true), 1e-11);
  }
}

// To the first order, moving the shaft by d changes each gap by nhat . d: what the solver relies
// on.
TEST(BoreContactsTest, GapsChangeAsTheirNormalsSay) {
  const Bore bore = MakeBore();
  const Pose X_WS(spatial::RotationFromVector(Vec3(0.01, 0.02, 0.5)), Vec3(30e-6, -50e-6, -8e-3));
  BoreContacts before;
  const std::size_t count = CalcBoreContacts(bore, Pose(), X_WS, kAll, &before);
  for (const Vec3& d : {Vec3(1e-8, 0, 0), Vec3(0, 1e-8, 0), Vec3(0, 0, 1e-8)}) {
    BoreContacts after;
    ASSERT_EQ(CalcBoreContacts(bore, Pose(), Pose(X_WS.q(), X_WS.p() + d), kAll, &after), count);
    for (std::size_t i = 0; i < count; i += kBoreDirections) {  // Those where the edge is deepest.
      EXPECT_NEAR(after[i].distance - before[i].distance, before[i].nhat_W.dot(d), 1e-12);
    }
  }
}

TEST(BoreContactsTest, EdgesThatAreNotInsideHaveNoContact) {
  BoreContacts contacts;
  EXPECT_EQ(CalcBoreContacts(MakeBore(), Pose(), Pose(Vec3(0, 0, 1e-3)), kAll, &contacts), 0u);
  // Through a hole that the shaft is longer than: both edges of the hole, none of the shaft.
  EXPECT_EQ(CalcBoreContacts(MakeBore(), Pose(), Pose(Vec3(0, 0, -40e-3)), kAll, &contacts),
            2 * kBoreDirections);
}

}  // namespace
}  // namespace hvas::haptics
