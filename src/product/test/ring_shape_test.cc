// Plain flat rings, closed and split, whatever they are called.

#include "product/ring_shape.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "product/bearable_strain.h"
#include "product/flexible.h"
#include "product/test/ring_mesh.h"

namespace hvas::product {
namespace {

using testing::MakeRingPart;

constexpr double kDegree = std::numbers::pi / 180;

TEST(RingShapeTest, AClosedRingHasNoGap) {
  const Part part = MakeRingPart({37e-3, 40e-3, 2e-3, 0});
  const auto ring = FindRingShape(part);
  ASSERT_TRUE(ring);
  EXPECT_EQ(ring->gap, 0);
  EXPECT_NEAR(ring->inner, 37e-3, 1e-6);
  EXPECT_NEAR(ring->outer, 40e-3, 1e-6);
  EXPECT_NEAR(ring->height, 2e-3, 1e-9);
  EXPECT_FALSE(ClassifyFlexibleByForm(part));
}

TEST(RingShapeTest, AGapOfHalfAMillimetreSplitsARing) {
  for (const double gap : {0.5e-3 / 37e-3, 30 * kDegree, 120 * kDegree}) {
    const Part part = MakeRingPart({37e-3, 40e-3, 2e-3, gap});
    const auto ring = FindRingShape(part);
    ASSERT_TRUE(ring) << gap;
    EXPECT_NEAR(ring->gap, gap, 1e-9);
    const auto flexible = ClassifyFlexibleByForm(part);
    ASSERT_TRUE(flexible) << gap;
    EXPECT_EQ(flexible->kind, FlexibleKind::kRetainingRing);
    EXPECT_NEAR(flexible->allowance, 8e-3, 1e-6);  // A tenth of its diameter.
  }
}

TEST(RingShapeTest, ATurnedRingIsTheSame) {
  const Quat turned(Eigen::AngleAxisd(0.8, Vec3(1, -2, 0.5).normalized()));
  const auto ring = FindRingShape(MakeRingPart({9e-3, 10.5e-3, 1e-3, 20 * kDegree}, turned));
  ASSERT_TRUE(ring);
  EXPECT_NEAR(ring->gap, 20 * kDegree, 1e-6);
  EXPECT_NEAR(std::abs(ring->axis_B.dot(turned * Vec3::UnitZ())), 1, 1e-9);
}

TEST(RingShapeTest, ATubeADiscAndAHookAreNoRings) {
  EXPECT_FALSE(FindRingShape(MakeRingPart({9e-3, 10e-3, 20e-3, 0.1})));
  EXPECT_FALSE(FindRingShape(MakeRingPart({2e-3, 10e-3, 1e-3, 0.1})));
  const Part hook = MakeRingPart({9e-3, 10e-3, 1e-3, 200 * kDegree});
  EXPECT_FALSE(ClassifyFlexibleByForm(hook));  // It holds no shaft.
}

TEST(RingShapeTest, TheNameOfASplitRingSaysNothing) {
  for (const char* name :
       {"part 7", "compression seal", "snap clip", "spring washer", "retainer"}) {
    Part part = MakeRingPart({37e-3, 40e-3, 2e-3, 0.02});
    part.name = name;
    const auto flexible = ClassifyFlexible(part);
    ASSERT_TRUE(flexible) << name;
    EXPECT_EQ(flexible->kind, FlexibleKind::kRetainingRing) << name;
    EXPECT_NEAR(flexible->allowance, 8e-3, 1e-6) << name;
  }
}

TEST(RingShapeTest, OpeningStrainsARingByTheChangeOfItsCurvature) {
  const auto ring = FindRingShape(MakeRingPart({37e-3, 40e-3, 2e-3, 0.02}));
  ASSERT_TRUE(ring);
  // w / 2 (1 / r - 1 / (r + y)) = 1.5 (1 / 38.5 - 1 / 41.5).
  EXPECT_NEAR(CalcOpeningStrain(*ring, 3e-3), 2.816e-3, 1e-6);
}

TEST(RingShapeTest, AWideRingOpensOnlyAsFarAsItsStrainAllows) {
  // 1 / (1 / 10 - 2 x 0.02 / 6) - 10 = 0.714 mm, below a tenth of its diameter.
  const auto flexible = ClassifyFlexibleByForm(MakeRingPart({7e-3, 13e-3, 2e-3, 0.2}));
  ASSERT_TRUE(flexible);
  EXPECT_NEAR(flexible->allowance, 0.714e-3, 2e-6);
}

TEST(BearableStrainTest, PlasticsMetalsAndRubberBearTheirOwn) {
  Material material;
  EXPECT_DOUBLE_EQ(FindBearableStrain(material), 0.04);  // Unknown: a plastic.
  EXPECT_DOUBLE_EQ(FindBearableRingStrain(material), 0.02);
  material.is_standard_assumed = false;
  material.standard = "51CrV4 Q&T";
  material.yield_strength = 900e6;
  EXPECT_DOUBLE_EQ(FindBearableStrain(material), 900e6 / 210e9);
  EXPECT_DOUBLE_EQ(FindBearableRingStrain(material), 0.02);
  EXPECT_EQ(DescribeBearing(material, "a plastic"), "51CrV4 Q&T");
  material.youngs_modulus = 2.8e9;
  EXPECT_DOUBLE_EQ(FindBearableStrain(material), 0.04);
  EXPECT_DOUBLE_EQ(FindBearableRingStrain(material), 0.04);
  material.name = "NBR 70";
  EXPECT_DOUBLE_EQ(FindBearableStrain(material), 1);
}

}  // namespace
}  // namespace hvas::product
