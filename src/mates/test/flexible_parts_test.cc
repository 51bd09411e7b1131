#include "mates/flexible_parts.h"

#include <gtest/gtest.h>

namespace hvas::mates {
namespace {

using product::OccurrenceId;
using product::Product;

/** A housing, two O-rings and a bracket. */
Product Rings() {
  Product product;
  const auto add = [&product](const std::string& name, int count) {
    product::Part part;
    part.id = product::PartId(product.parts.size());
    part.name = name;
    part.box_B = {Vec3::Zero(), Vec3(20e-3, 20e-3, 2e-3)};
    for (int i = 0; i < count; ++i) {
      product::Occurrence occurrence;
      occurrence.id = OccurrenceId(product.occurrences.size());
      occurrence.part = part.id;
      occurrence.name = name + (i == 0 ? "" : " 2");
      occurrence.path = "rig/" + occurrence.name;
      product.occurrences.push_back(occurrence);
    }
    product.parts.push_back(part);
  };
  add("housing", 1);
  add("O-ring", 2);
  add("bracket", 1);
  return product;
}

std::vector<std::pair<std::uint32_t, double>> List(const Product& product) {
  std::vector<std::pair<std::uint32_t, double>> list;
  for (const product::FlexiblePart& part : product.flexible) {
    list.emplace_back(part.occurrence.value(), part.allowance);
  }
  return list;
}

using Pairs = std::vector<std::pair<std::uint32_t, double>>;

TEST(FlexiblePartsTest, RecognisedPartsGiveUnlessTheyAreSaidToBeRigid) {
  Product product = Rings();
  Diagnostics diagnostics;
  ASSERT_TRUE(SetFlexibleParts({}, {}, &product, &diagnostics));
  EXPECT_EQ(List(product), (Pairs{{1, 2e-3}, {2, 2e-3}}));
  ASSERT_EQ(diagnostics.items().size(), 1U);  // One for equal parts.
  EXPECT_EQ(diagnostics.items()[0].code, "flexible-part");
  ASSERT_TRUE(SetFlexibleParts({}, {"O-ring 2"}, &product, &diagnostics));
  EXPECT_EQ(List(product), (Pairs{{1, 2e-3}, {2, 0}}));
  ASSERT_TRUE(SetFlexibleParts({}, {"all"}, &product, &diagnostics));
  EXPECT_EQ(List(product), (Pairs{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));  // Also what has no name.
}

TEST(FlexiblePartsTest, StatedAllowancesHoldOverRecognisedOnes) {
  Product product = Rings();
  Diagnostics diagnostics;
  ASSERT_TRUE(SetFlexibleParts({{"bracket", 0.4e-3, "here"}, {"O-ring 2", 0, "here"}}, {}, &product,
                               &diagnostics));
  EXPECT_EQ(List(product), (Pairs{{1, 2e-3}, {2, 0}, {3, 0.4e-3}}));
  EXPECT_EQ(product.flexible[2].kind, product::FlexibleKind::kStated);
  ASSERT_TRUE(SetFlexibleParts({{"O-ring", 0.5e-3, "here"}}, {"all"}, &product, &diagnostics));
  EXPECT_EQ(List(product), (Pairs{{0, 0}, {1, 0.5e-3}, {2, 0}, {3, 0}}));
}

TEST(FlexiblePartsTest, NameThatNothingHasIsAnErrorThatNamesIt) {
  Product product = Rings();
  Diagnostics diagnostics;
  const auto stated =
      SetFlexibleParts({{"spring", 1e-3, "a.hvas.json:4"}}, {}, &product, &diagnostics);
  ASSERT_FALSE(stated);
  EXPECT_EQ(stated.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(stated.error().where, "a.hvas.json:4");
  EXPECT_FALSE(SetFlexibleParts({}, {"spring"}, &product, &diagnostics));
}

}  // namespace
}  // namespace hvas::mates
