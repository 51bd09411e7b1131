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

TEST(TiltedShaft, StopsWhereItTouchesInTwoPoints) {
  for (const double depth : {10e-3, 20e-3, 40e-3}) {
    SCOPED_TRACE(::testing::Message() << "depth " << depth);
    testing::Rig rig(testing::MakeFit("H7/g6"), testing::Above(-depth), ContactAlone());
    const contact::BodyId bushing(0);
    rig.scene.SetOffsets(bushing,
                         Offset(testing::BushingShape(), kBore, kShaftRadius - 0.5 * kHole));
    rig.scene.SetOffsets(rig.part.body,
                         Offset(testing::ShaftShape(), kSide, 0.5 * kShaft - kShaftRadius));
    // About the middle of what is engaged, three times as far as it can go.
    const Vec3 turn(0, 3 * CalcTwoPointAngle(kHole, kShaft, depth), 0);
    const Vec3 from_pivot = rig.part.p_BoBcm_B - Vec3(0, 0, 0.5 * depth);
    rig.hand->MoveSoftly(turn.cross(from_pivot), 0.5, turn);
    rig.hand->Wait(0.3);
    const TickOutput& out = rig.hand->last();
    const Vec3 axis = out.X_WD.q() * Vec3::UnitZ();
    const double tilt = std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
    // Along the side, from the tip's corner to the rim of the mouth.
    const double l = (kLength - out.X_WD.p().z() + 0.5 * kShaft * std::sin(tilt)) / std::cos(tilt);
    EXPECT_NEAR(l, depth, 0.1e-3);
    const double truth = CalcTwoPointAngle(kHole, kShaft, l);
    EXPECT_NEAR(tilt, truth, 0.02 * truth);
    EXPECT_GE(out.contact_count, 2);
    EXPECT_EQ(out.state, HoldState::kFree);
  }
}

}  // namespace
}  // namespace hvas::haptics
