#include "mates/joints.h"

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Joint;
using product::Part;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;

/** A block with pins at the given points, in a plate with holes for them; with a face under it or
 not. */
Product MakePinned(const std::vector<Vec3>& pins, bool has_face) {
  Product product;
  AddPart(&product, "plate");
  AddPart(&product, "block");
  Part* plate = &product.parts[0];
  Part* block = &product.parts[1];
  for (const Vec3& p : pins) {
    AddCylinder(plate, FeatureKind::kHole, p, Vec3::UnitZ(), 3e-3, -10e-3, 0);
    AddCylinder(block, FeatureKind::kShaft, p, -Vec3::UnitZ(), 2.99e-3, 0, 8e-3);
  }
  AddRectangle(plate, Vec3::Zero(), Vec3::UnitZ(), 40e-3, 40e-3);
  AddRectangle(block, Vec3(0, 0, has_face ? 0 : 1e-3), -Vec3::UnitZ(), 30e-3, 30e-3);
  AddOccurrence(&product, product::PartId(0), Pose(Vec3(0.1, 0.2, 0.3)));
  AddOccurrence(&product, product::PartId(1), Pose(Vec3(0.1, 0.2, 0.3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

struct Freedom {
  const char* what;
  std::vector<Vec3> pins;
  bool has_face;
  int translations, rotations, pattern;
};

class JointFreedom : public ::testing::TestWithParam<Freedom> {};

// X2. By counting: 6 less 4 for an axis, less 3 for a face, less what both hold already.
TEST_P(JointFreedom, IsWhatTheMatesLeave) {
  const Freedom& freedom = GetParam();
  const Product product = MakePinned(freedom.pins, freedom.has_face);
  ASSERT_EQ(product.joints.size(), 1U);
  const Joint& joint = product.joints[0];
  EXPECT_EQ(joint.a.index(), 0U);
  EXPECT_EQ(joint.b.index(), 1U);
  EXPECT_EQ(joint.mates.size(), freedom.pins.size() + (freedom.has_face ? 1 : 0));
  EXPECT_EQ(joint.free_translations, freedom.translations) << freedom.what;
  EXPECT_EQ(joint.free_rotations, freedom.rotations) << freedom.what;
  EXPECT_EQ(joint.pattern_count, freedom.pattern) << freedom.what;
}

const Vec3 kNoOffset(0, 0, 0);
const Vec3 kRight(15e-3, 0, 0);
const Vec3 kLeft(-15e-3, 0, 0);
const Vec3 kUp(0, 15e-3, 0);

INSTANTIATE_TEST_SUITE_P(
    Counted, JointFreedom,
    ::testing::Values(Freedom{"one axis", {kNoOffset}, false, 1, 1, 0},
                      Freedom{"an axis and a face", {kNoOffset}, true, 0, 1, 0},
                      Freedom{"a face", {}, true, 2, 1, 0},
                      Freedom{"two dowels", {kRight, kLeft}, false, 1, 0, 2},
                      Freedom{"two dowels and a face", {kRight, kLeft}, true, 0, 0, 2},
                      Freedom{"a circle of three", {kRight, kLeft, kUp}, true, 0, 0, 3}));

TEST(Joints, AreOneForEachPairInTheirOrder) {
  Product product = MakePinned({kNoOffset}, true);
  AddPart(&product, "lid");
  AddRectangle(&product.parts[2], Vec3(0, 0, 0), Vec3::UnitZ(), 40e-3, 40e-3);
  AddRectangle(&product.parts[0], Vec3(0, 0, -10e-3), -Vec3::UnitZ(), 40e-3, 40e-3);
  AddOccurrence(&product, product::PartId(2), Pose(Vec3(0.1, 0.2, 0.29)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.joints.size(), 2U);
  EXPECT_EQ(product.joints[0].b.index(), 1U);
  EXPECT_EQ(product.joints[1].b.index(), 2U);
  std::size_t mates = 0;
  for (const Joint& joint : product.joints) {
    mates += joint.mates.size();
  }
  EXPECT_EQ(mates, product.mates.size());
}

}  // namespace
}  // namespace hvas::mates
