#include "mates/thread_joints.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Product;

/** A screw of 3 mm and 12 mm length, 8 mm of it in a hole. */
Product MakeScrewIn(double hole_diameter, const std::string& screw_name,
                    const std::string& hub_name) {
  Product product;
  product::Part* hub = testing::AddPart(&product, hub_name);
  testing::AddCylinder(hub, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 0.5 * hole_diameter, 0,
                       8e-3);
  product::Part* screw = testing::AddPart(&product, screw_name);
  testing::AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.5e-3, 0, 12e-3);
  for (const auto& part : {product::PartId(0), product::PartId(1)}) {
    testing::AddOccurrence(&product, part, spatial::Pose());
  }
  return product;
}

std::vector<ThreadJoint> FindIn(Product product) {
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return FindThreadJoints(product);
}

TEST(ThreadJoints, ScrewInItsTappedHoleHasSizePitchTurnsAndTorque) {
  for (const auto& [hole, expected] : {std::pair(2.5e-3, fits::ThreadHole::kCore),
                                       std::pair(3.0e-3, fits::ThreadHole::kNominal)}) {
    const auto joints = FindIn(MakeScrewIn(hole, "Screw M3x12", "plate"));
    ASSERT_EQ(joints.size(), 1U) << hole;
    ASSERT_NE(joints[0].thread, nullptr);
    EXPECT_EQ(joints[0].thread->designation, "M3");
    EXPECT_EQ(joints[0].kind, ThreadJointKind::kThreaded);
    EXPECT_EQ(joints[0].hole, expected);
    EXPECT_NEAR(joints[0].pitch, 0.5e-3, 1e-12);
    EXPECT_NEAR(joints[0].engaged, 8e-3, 1e-9);
    EXPECT_NEAR(joints[0].turns, 16, 1e-6);
    EXPECT_NEAR(joints[0].tightening.torque, 1.2, 0.15);  // [N m], as tables give it for M3 of 8.8.
    EXPECT_FALSE(joints[0].is_left_handed);
  }
}

TEST(ThreadJoints, AThroughHoleIsNone) {
  EXPECT_TRUE(FindIn(MakeScrewIn(3.4e-3, "Screw M3x12", "plate")).empty());
}

TEST(ThreadJoints, AScrewInPlasticAndOneNamedSoCutTheirThreads) {
  const auto named = FindIn(MakeScrewIn(2.5e-3, "ISO 7049 self-tapping screw", "plate"));
  ASSERT_EQ(named.size(), 1U);
  EXPECT_EQ(named[0].kind, ThreadJointKind::kSelfTapping);
  EXPECT_EQ(named[0].tightening.torque, 0);
  Product product = MakeScrewIn(2.5e-3, "Screw M3x12", "housing");
  product.parts[0].material.name = "ABS";
  product.parts[0].material.density = 1050;
  const auto in_plastic = FindIn(std::move(product));
  ASSERT_EQ(in_plastic.size(), 1U);
  EXPECT_EQ(in_plastic[0].kind, ThreadJointKind::kSelfTapping);
}

TEST(ThreadJoints, OnlyAMaterialThatIsAPlasticAsAWholeWordMakesAScrewSelfTapping) {
  for (const auto& [material, expected] :
       {std::pair("PLA", ThreadJointKind::kSelfTapping),
        std::pair("PETG black", ThreadJointKind::kSelfTapping),
        std::pair("Polypropylene", ThreadJointKind::kSelfTapping),
        std::pair("Steel plate", ThreadJointKind::kThreaded),
        std::pair("Plated", ThreadJointKind::kThreaded),
        std::pair("pompa", ThreadJointKind::kThreaded),
        std::pair("", ThreadJointKind::kThreaded)}) {
    Product product = MakeScrewIn(2.5e-3, "Screw M3x12", "housing");
    product.parts[0].material.name = material;
    const auto joints = FindIn(std::move(product));
    ASSERT_EQ(joints.size(), 1U) << material;
    EXPECT_EQ(joints[0].kind, expected) << material;
  }
}

/** A shaft in a hole, both without any name of a fastener, 2.5 diameters of it engaged. */
Product MakeNamelessPair(double hole, double shaft, double bore = 0) {
  Product product;
  product::Part* hub = testing::AddPart(&product, "part 1");
  testing::AddCylinder(hub, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 0.5 * hole, 0,
                       2.5 * shaft);
  product::Part* screw = testing::AddPart(&product, "part 2");
  testing::AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 0.5 * shaft, 0,
                       3 * shaft);
  if (bore > 0) {
    testing::AddCylinder(screw, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 0.5 * bore, 0,
                         3 * shaft);
  }
  for (const auto& part : {product::PartId(0), product::PartId(1)}) {
    testing::AddOccurrence(&product, part, spatial::Pose());
  }
  return product;
}

TEST(ThreadJoints, TwoDiametersOfAnyThreadAreItWithoutANameAlsoWhereTheScrewIsHollow) {
  for (const fits::Thread& thread : fits::ListThreads()) {
    SCOPED_TRACE(thread.designation);
    for (const double bore : {0.0, 0.6 * thread.diameter}) {
      const auto joints = FindIn(MakeNamelessPair(thread.minor_diameter(), thread.diameter, bore));
      ASSERT_EQ(joints.size(), 1U);
      ASSERT_NE(joints[0].thread, nullptr);
      EXPECT_EQ(joints[0].thread->designation, thread.designation);
      EXPECT_NEAR(joints[0].turns, 2.5 * thread.diameter / thread.pitch, 1e-6);
    }
  }
}

TEST(ThreadJoints, APinAndABearingInASmallerHoleAreNoThreadWhateverTheDiameters) {
  for (const char* name : {"bearing 6206", "Kugellager", "Zylinderstift", "dowel pin"}) {
    Product product = MakeNamelessPair(28.376e-3, 30e-3);
    product.parts[1].name = name;
    EXPECT_TRUE(FindIn(std::move(product)).empty()) << name;
  }
}

TEST(ThreadJoints, ANameThatStatesTheSizeAloneLeavesThePitchToTheDiameters) {
  for (const auto& [name, expected] :
       {std::pair("nut M8", "M8x1"), std::pair("nut M8x0.75", "M8x0.75"),
        std::pair("Mutter M8x1,25", "M8"), std::pair("part", "M8x1")}) {
    Product product = MakeNamelessPair(6.917e-3, 8e-3);
    product.parts[0].name = name;
    const auto joints = FindIn(std::move(product));
    ASSERT_EQ(joints.size(), 1U) << name;
    EXPECT_EQ(joints[0].thread->designation, expected) << name;
  }
}

}  // namespace
}  // namespace hvas::mates
