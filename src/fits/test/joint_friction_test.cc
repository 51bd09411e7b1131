#include "fits/joint_friction.h"

#include <gtest/gtest.h>

namespace hvas::fits {
namespace {

PressFriction Find(const char* hub, const char* shaft, const JoiningWay& way = {}) {
  return FindPressFriction(*FindMaterial(hub)->material, *FindMaterial(shaft)->material, way);
}

void ExpectFriction(const PressFriction& friction, double in, double release, double slip) {
  EXPECT_EQ(friction.in, in) << friction.source;
  EXPECT_EQ(friction.release, release) << friction.source;
  EXPECT_EQ(friction.slip, slip) << friction.source;
}

// DIN 7190-1, 5.2 holds; the upper end of the design values has to be pressed in.
TEST(JointFriction, PressedPairsHoldWithTheLowAndArePressedWithTheHighValue) {
  ExpectFriction(Find("S235", "C45"), 0.20, 0.10, 0.09);
  ExpectFriction(Find("S355", "C45"), 0.20, 0.10, 0.08);
  ExpectFriction(Find("GE240", "C45"), 0.20, 0.11, 0.08);
  ExpectFriction(Find("S235", "C45", {false, true}), 0.12, 0.07, 0.06);
  ExpectFriction(Find("EN-GJL-250", "C45"), 0.12, 0.12, 0.11);
  ExpectFriction(Find("EN-GJL-250", "C45", {false, true}), 0.08, 0.06, 0.05);
  ExpectFriction(Find("EN-GJS-600-3", "C45"), 0.12, 0.10, 0.09);
  ExpectFriction(Find("AW-6061", "C45"), 0.07, 0.07, 0.06);
  ExpectFriction(Find("CuSn8", "C45"), 0.10, 0.07, 0.06);
  ExpectFriction(Find("CuSn8", "C45", {false, true}), 0.10, 0.05, 0.05);
  // In either order.
  ExpectFriction(Find("C45", "CuSn8"), 0.10, 0.07, 0.06);
}

// DIN 7190-1, 5.3.
TEST(JointFriction, ShrunkPairsHoldWithTheTransverseValues) {
  EXPECT_EQ(Find("S355", "C45", {true, false}).release, 0.15);
  EXPECT_EQ(Find("S355", "C45", {true, true}).release, 0.12);
  EXPECT_EQ(Find("EN-GJL-250", "C45", {true, false}).release, 0.10);
  EXPECT_EQ(Find("AW-6061", "C45", {true, false}).release, 0.10);
  EXPECT_EQ(Find("CuZn37", "C45", {true, false}).release, 0.17);
}

TEST(JointFriction, PairsThatTheTableHasNotAreAssumedOnTheSafeSide) {
  for (const auto& [hub, shaft] : {std::pair("POM-C", "C45"), std::pair("AW-6061", "CuSn8"),
                                   std::pair("Inconel 718", "C45")}) {
    const PressFriction friction = Find(hub, shaft);
    EXPECT_TRUE(friction.is_assumed) << hub;
    EXPECT_LT(friction.release, friction.in) << hub;
  }
  for (const Material& material : Materials()) {
    for (const JoiningWay way :
         {JoiningWay{false, false}, {false, true}, {true, false}, {true, true}}) {
      const PressFriction friction = FindPressFriction(material, DefaultMaterial(), way);
      EXPECT_GT(friction.slip, 0) << material.name;
      EXPECT_LE(friction.slip, friction.release) << material.name;
      EXPECT_LE(friction.release, friction.in) << material.name;
      EXPECT_FALSE(friction.source.empty()) << material.name;
    }
  }
}

}  // namespace
}  // namespace hvas::fits
