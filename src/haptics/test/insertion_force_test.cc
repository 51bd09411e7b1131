// What the hand feels while a peg goes into a hole beside the axis and tilted, as Whitney's
// compliantly supported peg: one point of contact at the hole's rim, then two (N5).

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "haptics/test/led_peg.h"

namespace hvas::haptics {
namespace {

using testing::CalcOnChamfer;
using testing::CalcOnePoint;
using testing::CalcTwoPoint;
using testing::kCentre;
using testing::kChamfer;
using testing::kHoleDepth;
using testing::kHoleRadius;
using testing::kMu;
using testing::kOffset;
using testing::kPegLength;
using testing::kPegRadius;
using testing::kTilt;
using testing::PegRig;
using testing::PlanarLoad;
using testing::PlanarSpring;

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

  PlanarSpring spring{};
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

// Crossing a chamfer by contact alone: the slope pushes the peg onto the axis.
TEST(InsertionForce, ChamferIsCrossedAsItsEquilibriumSays) {
  constexpr double kSpeed = 0.2e-3;   // [m/s]
  constexpr double kAllowed = 1e-2;   // Of the force: dampers, and what a contact gives way.
  constexpr double kMesh = 1e-6;      // [m]
  constexpr double kBeside = 0.9e-3;  // Of the hand's path [m].
  TickOptions options = testing::HardAndWeightless();
  options.condition = Condition::kCollision;
  options.contact.friction = {kMu, kMu};
  testing::HeldRig rig(options);
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  const double mouth = kHoleRadius + kChamfer;
  const spatial::Surface slope{spatial::SurfaceKind::kCone,
                               Vec3(0, 0, kHoleDepth - mouth),
                               Vec3::UnitZ(),
                               0,
                               std::atan(1.0),
                               -1};
  const auto hole = contact::testing::Build(contact::testing::Lathe(
      {{{{kHoleRadius, 0}, {20e-3, 0}}, PlaneAt(0, -1)},
       {{{20e-3, 0}, {20e-3, kHoleDepth}}, CylinderZ(20e-3, 1)},
       {{{20e-3, kHoleDepth}, {mouth, kHoleDepth}}, PlaneAt(kHoleDepth, 1)},
       {{{mouth, kHoleDepth}, {kHoleRadius, kHoleDepth - kChamfer}}, slope},
       {{{kHoleRadius, kHoleDepth - kChamfer}, {kHoleRadius, 0}}, CylinderZ(kHoleRadius, -1)}},
      contact::testing::Segments(kHoleRadius, 1e-6)));
  const auto peg = contact::testing::Build(contact::testing::Shaft(kPegRadius, kPegLength, 1e-6));
  rig.scene.Add(hole, spatial::Pose());
  rig.Place(peg, spatial::Pose(Vec3(kBeside, 0, kHoleDepth + 1e-3)));
  testing::SetMass({{kPegRadius, 0, kPegLength}}, &rig.part);
  rig.part.X_WB_goal = spatial::Pose(Vec3(0, 0, -1));
  rig.Take();
  rig.hand->Wait(0.3);
  const PlanarSpring spring{rig.options.coupling.k_lin, rig.options.coupling.k_rot, kBeside};
  rig.hand->MoveSoftly(Vec3(0, 0, -1.3e-3), 0.5);
  int compared = 0;
  double worst = 0;
  while (rig.hand->pose().p().z() - kCentre > kHoleDepth - 0.75e-3) {
    rig.hand->MoveEvenly(Vec3(0, 0, -0.02e-3), 0.02e-3 / kSpeed);
    const double depth = kHoleDepth - rig.hand->last().X_WD.p().z();
    if (rig.hand->last().contact_count == 0 || depth < 0.35e-3) {
      continue;  // Not there yet, or still moving onto the slope.
    }
    ++compared;
    const PlanarLoad expected = CalcOnChamfer(spring, depth);
    const spatial::Wrench& felt = rig.hand->last().F_felt_W;
    // The meshes deviate by 1 um, which bends the hand's spring.
    const auto expect_near = [&](double found, double wanted, double lever) {
      EXPECT_NEAR(found, wanted, kAllowed * std::abs(wanted) + lever * kMesh * spring.k_x) << depth;
      worst = std::max(worst, std::abs(found / wanted - 1));
    };
    expect_near(felt.f.x(), expected.f_x, 1);
    expect_near(felt.f.z(), expected.f_z, (1 + kMu) / (1 - kMu));
    expect_near(felt.t.y(), expected.m, kCentre);
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(compared, 8);
}

}  // namespace
}  // namespace hvas::haptics
