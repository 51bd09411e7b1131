// A peg with play in a hole, as a mate with a clearance fit has it, in a scripted hand: two points
// of contact, wedging and jamming as the closed forms of Whitney's peg in a hole have them (N5).

#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "fits/insertion.h"
#include "haptics/test/peg_rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::kHoleDepth;
using testing::kHoleRadius;
using testing::kPair;
using testing::kPegRadius;
using testing::PegRig;

TEST(Jamming, TouchesAtTwoPointsAtTheDepthOfTheClosedForm) {
  for (const auto& [degrees, depth_mm] :
       {std::pair(1.0, 22.9160), std::pair(3.0, 7.6323), std::pair(6.0, 3.8043)}) {
    SCOPED_TRACE(degrees);
    const double t = degrees * std::numbers::pi / 180;
    ASSERT_NEAR(fits::CalcTipDepth(kPair, t), 1e-3 * depth_mm, 0.1e-6);
    PegRig rig(1e-3 * depth_mm, 0);
    rig.Tilt(0.9 * t, 0.5);
    for (int i = 0; i < 100 && rig.hand->last().contact_count < 2; ++i) {
      rig.Tilt(0.005 * t, 0.02);
      rig.hand->Wait(0.05);
    }
    ASSERT_EQ(rig.hand->last().contact_count, 2);
    EXPECT_NEAR(rig.CalcTilt(), t, 0.2 * t);
    EXPECT_NEAR(rig.CalcTipDepth(), fits::CalcTipDepth(kPair, rig.CalcTilt()), 1e-6);
  }
}

/** What the hand does to the peg, as forces at two points where the peg slides in: on the corner of
 its tip and on the mouth's far edge. */
struct SlidingForces {
  double tip{0}, mouth{0};  ///< Normal forces [N].
  double rest{0};           ///< Of the hand's force that these two do not explain, along z [N].
};

SlidingForces ExplainBySliding(const PegRig& rig, double friction) {
  const TickOutput& out = rig.hand->last();
  const double t = rig.CalcTilt();
  const Vec3 f = -out.F_felt_W.f;
  const Vec3 p_WMouth(kHoleRadius, 0, kHoleDepth);
  const Vec3 p_WTip = out.X_WD * Vec3(-kPegRadius, 0, 0);
  const Vec3 m = -out.F_felt_W.t + (out.X_WD * rig.part.p_BoBcm_B - p_WMouth).cross(f);
  // Of a unit of normal force, with friction against the motion inwards.
  const Vec3 at_tip(1, 0, friction);
  const Vec3 at_mouth(-std::cos(t) + friction * std::sin(t), 0,
                      std::sin(t) + friction * std::cos(t));
  SlidingForces forces;
  forces.tip = -m.y() / (p_WTip - p_WMouth).cross(at_tip).y();
  forces.mouth = -(f.x() + forces.tip * at_tip.x()) / at_mouth.x();
  forces.rest = f.z() + forces.tip * at_tip.z() + forces.mouth * at_mouth.z();
  return forces;
}

// A load on an edge of the jamming parallelogram is one that two sliding points bear: as long as
// the peg slides in, the hand's is one, to what the speed does.
TEST(Jamming, SlidesInOnTheEdgeOfTheParallelogram) {
  constexpr double kFriction = 0.3;
  constexpr double kSpeed = 1e-5;  // [m/s]: what the speed does is a millionth of the load then.
  for (const double depth : {15e-3, 20e-3, 25e-3}) {
    SCOPED_TRACE(depth);
    PegRig rig(depth, kFriction);
    rig.Tilt(1.3 * fits::CalcTwoPointTilt(kPair, depth), 0.5);
    rig.hand->MoveEvenly(Vec3(0, 0, -6e-3), 2);
    rig.hand->MoveEvenly(Vec3(0, 0, -200 * kSpeed), 2);
    rig.hand->MoveEvenly(Vec3(0, 0, -20 * kSpeed), 2);
    const double before = rig.CalcTipDepth();
    rig.hand->MoveEvenly(Vec3(0, 0, -2 * kSpeed), 2);
    EXPECT_NEAR(rig.CalcTipDepth() - before, 2 * kSpeed, 0.1 * kSpeed);  // It slides.
    const SlidingForces forces = ExplainBySliding(rig, kFriction);
    EXPECT_GT(forces.tip, 0.1);
    EXPECT_GT(forces.mouth, 0.1);
    EXPECT_LT(std::abs(forces.rest), 1e-6 * rig.hand->last().F_felt_W.f.norm());
  }
}

/** A peg tilted and squeezed between its two points as if it had been driven in: both 0.1 um deep.
 */
PegRig MakeSqueezed(double tilt, double friction) {
  constexpr double kSqueeze = 0.1e-6;
  const Quat q = spatial::RotationFromVector(Vec3(0, tilt, 0));
  const double l =
      (2 * kHoleRadius + kSqueeze - (2 * kPegRadius - kSqueeze) * std::cos(tilt)) / std::sin(tilt);
  return {friction,
          Pose(q, Vec3(kHoleRadius, 0, kHoleDepth) - q * Vec3(kPegRadius - kSqueeze, 0, l))};
}

// The hand is next to nothing: what holds the peg is its two points, each within the friction cone
// of the other, or it springs out. Stiff friction begins with a jerk, which lets go what is wedged
// by less than 0.1 degrees.
TEST(Jamming, WedgesBeyondTheTiltOfTheExactCones) {
  for (const double friction : {0.3, 0.6}) {
    const double onset_deg = fits::CalcWedgingTilt(kPair, friction) * 180 / std::numbers::pi;
    EXPECT_NEAR(onset_deg, friction == 0.3 ? 11.66 : 4.06, 0.02);
    for (const double beyond_deg : {-1.0, -0.1, -0.02, 0.1, 0.3, 1.0}) {
      SCOPED_TRACE(::testing::Message() << friction << ", " << beyond_deg);
      PegRig rig = MakeSqueezed((onset_deg + beyond_deg) * std::numbers::pi / 180, friction);
      rig.hand->Wait(1e-3);
      ASSERT_EQ(rig.hand->last().contact_count, 2);
      rig.hand->Wait(0.5);
      const double force = rig.hand->last().f_C_W.norm();
      EXPECT_TRUE(beyond_deg > 0 ? force > 3 : force < 1e-3) << force;
    }
  }
}

}  // namespace
}  // namespace hvas::haptics
