#include "mates/mate_key.h"

#include <set>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::Part;
using product::PartId;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;

Product MakePosts(int count, bool has_more_features) {
  Product product;
  AddPart(&product, "plate");
  AddPart(&product, "post");
  Part* plate = &product.parts[0];
  if (has_more_features) {
    AddCylinder(plate, FeatureKind::kHole, Vec3(0, 0.2, 0), Vec3::UnitZ(), 2e-3, -10e-3, 0);
  }
  for (int i = 0; i < count; ++i) {
    AddCylinder(plate, FeatureKind::kHole, Vec3(0.02 * i, 0, 0), Vec3::UnitZ(), 3e-3, -10e-3, 0);
  }
  AddCylinder(&product.parts[1], FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 3e-3, -8e-3,
              20e-3);
  AddOccurrence(&product, PartId(0), Pose());
  for (int i = 0; i < count; ++i) {
    AddOccurrence(&product, PartId(1), Pose(Vec3(0.02 * i, 0, 0)));
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

TEST(MateKey, IsTenHexDigitsAndUnique) {
  const Product product = MakePosts(200, false);
  ASSERT_EQ(product.mates.size(), 200U);
  std::set<std::string> keys;
  for (const product::Mate& mate : product.mates) {
    EXPECT_EQ(mate.key.size(), 10U);
    EXPECT_EQ(mate.key.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_TRUE(keys.insert(mate.key).second);
  }
}

// The side file names mates by key: they must outlast changes elsewhere in the product.
TEST(MateKey, StaysWhateverOtherMatesAndFeaturesThereAre) {
  const Product few = MakePosts(3, false);
  const Product many = MakePosts(9, true);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(few.mates[i].key, many.mates[i].key);
  }
}

TEST(MateKey, TellsKindsOccurrencesAndFeaturesApart) {
  Product product = MakePosts(2, false);
  product::Mate mate = product.mates[0];
  const std::string key = CalcKey(product, mate);
  EXPECT_EQ(key, mate.key);
  mate.kind = product::MateKind::kFaceFace;
  EXPECT_NE(CalcKey(product, mate), key);
  mate = product.mates[0];
  mate.b.occurrence = product::OccurrenceId(2);
  EXPECT_NE(CalcKey(product, mate), key);
  mate = product.mates[0];
  mate.a.feature = product::FeatureId(1);
  EXPECT_NE(CalcKey(product, mate), key);
}

TEST(MateKey, TheSameGeometryTwiceStillHasTwoKeys) {
  Product product = MakePosts(1, false);
  product.mates.push_back(product.mates[0]);
  AssignKeys(&product);
  EXPECT_NE(product.mates[0].key, product.mates[1].key);
}

}  // namespace
}  // namespace hvas::mates
