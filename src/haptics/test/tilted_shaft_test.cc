// A shaft as made in a hole as made, tilted by the hand until it touches in two points: W1, W2.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "contact/face_offsets.h"
#include "haptics/test/rig.h"

namespace hvas::haptics {
namespace {

using spatial::Pose;
using testing::kLength;
using testing::kShaftRadius;

constexpr std::size_t kSide = 1;      // Of testing::ShaftShape.
constexpr std::size_t kBore = 3;      // Of testing::BushingShape.
constexpr double kHole = 40.0125e-3;  // 40 H7/g6, mean sizes.
constexpr double kShaft = 39.983e-3;

std::shared_ptr<const contact::FaceOffsets> Offset(
    const std::shared_ptr<const contact::Shape>& shape, std::size_t face, double offset) {
  std::vector<contact::FaceOffset> offsets(face + 1);
  offsets[face].uniform = offset;
  return contact::FaceOffsets::Make(shape, offsets).value();
}

/** The tick with contact alone, on surfaces as stiff as steel: a soft contact would let the shaft
 tilt further by what its two points give way. */
TickOptions ContactAlone() {
  TickOptions options;
  options.condition = Condition::kCollision;
  options.gravity_W.setZero();
  options.contact.compliance = 2e-8;
  return options;
}

double CalcTwoPointAngle(double D, double d, double l) {
  return std::atan2(l, d) - std::acos(D / std::hypot(d, l));
}

/** The shaft at a depth, tilted by the hand `excess` times as far as it can go. */
struct TiltedRig : testing::Rig {
  TiltedRig(double depth, double excess)
      : Rig(testing::MakeFit("H7/g6"), testing::Above(-depth), ContactAlone()) {
    const contact::BodyId bushing(0);
    scene.SetOffsets(bushing, Offset(testing::BushingShape(), kBore, kShaftRadius - 0.5 * kHole));
    scene.SetOffsets(part.body, Offset(testing::ShaftShape(), kSide, 0.5 * kShaft - kShaftRadius));
    // About the middle of what is engaged.
    const Vec3 turn(0, excess * CalcTwoPointAngle(kHole, kShaft, depth), 0);
    const Vec3 from_pivot = part.p_BoBcm_B - Vec3(0, 0, 0.5 * depth);
    hand->MoveSoftly(turn.cross(from_pivot), 0.5, turn);
    hand->Wait(0.3);
  }

  [[nodiscard]] double CalcTilt() const {
    const Vec3 axis = hand->last().X_WD.q() * Vec3::UnitZ();
    return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
  }

  /** Along the side, from the tip's corner to the rim of the mouth. */
  [[nodiscard]] double CalcDepth() const {
    const double tilt = CalcTilt();
    const double height = hand->last().X_WD.p().z();
    return (kLength - height + 0.5 * kShaft * std::sin(tilt)) / std::cos(tilt);
  }
};

TEST(TiltedShaft, StopsWhereItTouchesInTwoPoints) {
  for (const double depth : {10e-3, 20e-3, 40e-3}) {
    SCOPED_TRACE(::testing::Message() << "depth " << depth);
    const TiltedRig rig(depth, 3);
    const double l = rig.CalcDepth();
    EXPECT_NEAR(l, depth, 0.1e-3);
    const double truth = CalcTwoPointAngle(kHole, kShaft, l);
    EXPECT_NEAR(rig.CalcTilt(), truth, 0.02 * truth);
    EXPECT_GE(rig.hand->last().contact_count, 2);
    EXPECT_EQ(rig.hand->last().state, HoldState::kFree);
  }
}

// Pushed in while it touches in two points, the force and the moment of the hand say down to which
// depth such a shaft wedges: mu d (Whitney). With f1 on the tip's corner at (-d/2, 0) and f2 on the
// rim at (d/2, l), both sliding, what the hand does about the tip's centre in the shaft's plane is
//   F_x = f2 - f1,  F_z = -mu (f1 + f2),  M = l f2 + mu (d/2) (f2 - f1).
TEST(TiltedShaft, SlidesInAsTheDepthOfWedgingSays) {
  for (const double depth : {20e-3, 30e-3}) {
    SCOPED_TRACE(::testing::Message() << "depth " << depth);
    TiltedRig rig(depth, 10);
    rig.hand->MoveEvenly(Vec3(0, 0, -4e-3), 0.4);
    rig.hand->MoveEvenly(Vec3(0, 0, -2e-3), 1);  // Slowly, so that nothing but friction resists.
    const TickOutput& out = rig.hand->last();
    const double l = rig.CalcDepth();
    ASSERT_GT(l, depth + 4e-3);  // It slides.
    // What the hand does to the part, in the part's frame, about the tip's centre.
    const Vec3 f = -(out.X_WD.q().conjugate() * out.F_felt_W.f);
    const Vec3 t = -(out.X_WD.q().conjugate() * out.F_felt_W.t) + rig.part.p_BoBcm_B.cross(f);
    double mu = 0.1;
    for (int i = 0; i < 50; ++i) {
      mu = -f.z() * l / (2 * t.y() - l * f.x() - mu * kShaft * f.x());
    }
    const double truth = rig.options.contact.friction.kinetic_coefficient * kShaft;
    EXPECT_NEAR(mu * kShaft, truth, 0.02 * truth);
  }
}

}  // namespace
}  // namespace hvas::haptics
