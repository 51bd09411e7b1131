// What the hand feels while a peg goes into a hole beside the axis and tilted, as Whitney's
// compliantly supported peg: one point of contact at the hole's rim, then two (N5).

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "fits/insertion.h"
#include "haptics/test/peg_rig.h"

namespace hvas::haptics {
namespace {

using testing::kHoleDepth;
using testing::kHoleRadius;
using testing::kPair;
using testing::kPegLength;
using testing::kPegRadius;
using testing::PegRig;

constexpr double kMu = 0.2;
constexpr double kCentre = 0.5 * kPegLength;  // Height of the centre of mass above the tip [m].
constexpr double kOffset = 0.5e-3;            // How far the tip is led into the wall [m].
constexpr double kTilt = 0.02;                // Of the hand [rad].

/** In the plane of the tilt: forces of the hole on the peg, and the moment about its centre. */
struct PlanarLoad {
  double f_x{0}, f_z{0}, m{0};
};

/** A peg in the plane of its tilt, with the axis of the hole along z and the rim at z = 0. */
struct PlanarPeg {
  double x_tip, depth, tilt;

  [[nodiscard]] Vec3 axis() const { return {std::sin(tilt), 0, std::cos(tilt)}; }

  [[nodiscard]] Vec3 across() const { return {std::cos(tilt), 0, -std::sin(tilt)}; }

  [[nodiscard]] Vec3 tip() const { return {x_tip, 0, -depth}; }

  [[nodiscard]] Vec3 centre() const { return tip() + kCentre * axis(); }

  /** Of a normal force of 1 N on the side at the rim, with friction against the motion inwards. */
  [[nodiscard]] Vec3 ForceAtRim() const { return -across() + kMu * axis(); }

  [[nodiscard]] double MomentAtRim() const {
    return (Vec3(kHoleRadius, 0, 0) - centre()).cross(ForceAtRim()).y();
  }
};

/** The hand's spring: where it leads the centre, and its tilt. */
struct Spring {
  double k_x, k_t;
  double x;  ///< Of the centre that is led [m].

  [[nodiscard]] double ForceOn(const PlanarPeg& peg) const { return k_x * (x - peg.centre().x()); }

  [[nodiscard]] double MomentOn(const PlanarPeg& peg) const { return k_t * (kTilt - peg.tilt); }
};

/** The root of a function that rises or falls through zero once in between. */
template <typename Function>
double FindRoot(double low, double high, const Function& function) {
  const bool rises = function(high) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((function(middle) > 0) == rises ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/** With its side on the rim, at a tilt. */
PlanarPeg MakeOnRim(double depth, double tilt) {
  return {kHoleRadius - (kPegRadius + depth * std::sin(tilt)) / std::cos(tilt), depth, tilt};
}

/** The equilibrium of a peg that slides in on one point, without small angles. */
PlanarLoad CalcOnePoint(const Spring& spring, double depth) {
  const auto force = [&](const PlanarPeg& peg) {
    return -spring.ForceOn(peg) / peg.ForceAtRim().x();
  };
  const double tilt = FindRoot(-0.05, 0.1, [&](double t) {
    const PlanarPeg peg = MakeOnRim(depth, t);
    return spring.MomentOn(peg) + force(peg) * peg.MomentAtRim();
  });
  const PlanarPeg peg = MakeOnRim(depth, tilt);
  const Vec3 f = force(peg) * peg.ForceAtRim();
  return {f.x(), f.z(), force(peg) * peg.MomentAtRim()};
}

/** The forces of two sliding points on a peg whose pose they determine. */
PlanarLoad CalcTwoPoint(const Spring& spring, double depth) {
  const double tilt = FindRoot(1e-4, 0.9 * fits::CalcLargestTilt(kPair),
                               [&](double t) { return fits::CalcTipDepth(kPair, t) - depth; });
  const PlanarPeg peg{kPegRadius * std::cos(tilt) - kHoleRadius, depth, tilt};
  const Vec3 at_tip(1, 0, kMu);
  const double m_tip = (peg.tip() - kPegRadius * peg.across() - peg.centre()).cross(at_tip).y();
  // tip * at_tip + rim * ForceAtRim() balances the spring, in x and about y.
  const double f = -spring.ForceOn(peg);
  const double m = -spring.MomentOn(peg);
  const Vec3 at_rim = peg.ForceAtRim();
  const double rim = (m - f * m_tip) / (peg.MomentAtRim() - at_rim.x() * m_tip);
  const double tip = f - rim * at_rim.x();
  return {f, kMu * tip + rim * at_rim.z(), m};
}

struct InsertionRig : PegRig {
  explicit InsertionRig(double depth) : PegRig(depth, kMu) {
    const double x_tip = kHoleRadius - kPegRadius + kOffset;
    spring = {options.coupling.k_lin, options.coupling.k_rot, x_tip + kCentre * std::sin(kTilt)};
    hand->MoveSoftly(Vec3(spring.x, 0, kCentre * (std::cos(kTilt) - 1)), 0.5, Vec3(0, kTilt, 0));
  }

  [[nodiscard]] PlanarLoad felt() const {
    const spatial::Wrench& F = hand->last().F_felt_W;
    return {F.f.x(), F.f.z(), F.t.y()};
  }

  Spring spring{};
};

/** @param allowed  What of the largest force and moment of the insertion the two may differ by. */
void ExpectNear(const PlanarLoad& felt, const PlanarLoad& expected, double allowed) {
  EXPECT_NEAR(felt.f_x, expected.f_x, allowed * 1.2);
  EXPECT_NEAR(felt.f_z, expected.f_z, allowed * 0.5);
  EXPECT_NEAR(felt.m, expected.m, allowed * 0.025);
}

// The dampers of the hand's spring add 8 N s/m times the speed across, a fiftieth of that along:
// 2e-4 N here.
TEST(InsertionForce, OneAndTwoPointsAsTheirEquilibriumSays) {
  constexpr double kSpeed = 1e-3;      // [m/s]
  constexpr double kAllowed = 1.5e-3;  // Of the largest force and moment.
  constexpr double kSmallAngles =
      1e-2;  // What Whitney's equation leaves out at tilts of 0.02 to 0.03.
  InsertionRig rig(5e-3);
  int one_point = 0;
  int two_points = 0;
  while (rig.CalcTipDepth() < 0.85 * kHoleDepth) {
    rig.hand->MoveEvenly(Vec3(0, 0, -0.5e-3), 0.5e-3 / kSpeed);
    const double depth = rig.CalcTipDepth();
    SCOPED_TRACE(::testing::Message() << "depth " << depth);
    if (rig.hand->last().contact_count == 1) {
      ++one_point;
      EXPECT_EQ(two_points, 0);
      const PlanarLoad expected = CalcOnePoint(rig.spring, depth);
      ExpectNear(rig.felt(), expected, kAllowed);
      const fits::InsertionForce whitney = fits::CalcOnePointForce(
          {rig.spring.k_x, rig.spring.k_t, kCentre}, kPegRadius, kMu, kOffset, kTilt, depth);
      EXPECT_NEAR(-rig.felt().f_x, whitney.f_x, kSmallAngles * whitney.f_x);
      // The wall of the peg leans: its normal force pushes outwards as well, which small angles
      // leave out.
      const double leaning = 1 + std::tan(rig.CalcTilt()) / kMu;
      EXPECT_NEAR(rig.felt().f_z, leaning * whitney.f_z, kSmallAngles * whitney.f_z);
    } else {
      ++two_points;
      ASSERT_EQ(rig.hand->last().contact_count, 2);
      ExpectNear(rig.felt(), CalcTwoPoint(rig.spring, depth), kAllowed);
    }
  }
  EXPECT_GE(one_point, 20);
  EXPECT_GE(two_points, 30);
}

}  // namespace
}  // namespace hvas::haptics
