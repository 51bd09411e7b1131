// X16: tools and fixtures in the tree of a product.

#include "product/accessories.h"

#include <gtest/gtest.h>

#include "product/product_io.h"
#include "product/validate.h"

namespace hvas::product {
namespace {

Product MakeOnePart(const std::string& name) {
  Product product;
  product.name = name;
  Part part;
  part.id = PartId(0);
  part.name = name;
  product.parts.push_back(part);
  Subassembly root;
  root.id = SubassemblyId(0);
  root.name = name;
  root.occurrences = {OccurrenceId(0)};
  product.subassemblies.push_back(root);
  Occurrence occurrence;
  occurrence.id = OccurrenceId(0);
  occurrence.part = PartId(0);
  occurrence.parent = SubassemblyId(0);
  occurrence.name = name;
  occurrence.path = name;
  product.occurrences.push_back(occurrence);
  return product;
}

TEST(AccessoriesX16, AreInTheTreeByTheirKindAndSurviveSerialisation) {
  Product product = MakeOnePart("base");
  EXPECT_TRUE(ListAccessories(product, AccessoryKind::kTool).empty());
  AddAccessory(MakeOnePart("key"), AccessoryKind::kTool, Pose(), &product);
  AddAccessory(MakeOnePart("vise"), AccessoryKind::kFixture, Pose(Vec3(1, 2, 3)), &product);
  AddAccessory(MakeOnePart("key"), AccessoryKind::kTool, Pose(), &product);
  const auto again = DeserialiseProduct(SerialiseProduct(product));
  ASSERT_TRUE(again);
  for (const Product& each : {product, *again}) {
    EXPECT_EQ(ListAccessories(each, AccessoryKind::kTool),
              (std::vector<OccurrenceId>{OccurrenceId(1), OccurrenceId(3)}));
    EXPECT_EQ(ListAccessories(each, AccessoryKind::kFixture),
              std::vector<OccurrenceId>{OccurrenceId(2)});
    EXPECT_EQ(each.occurrences[2].X_WB.p(), Vec3(1, 2, 3));
    EXPECT_EQ(each.occurrences[3].path, "workshop tools/key#2");
    EXPECT_EQ(each.part_of(OccurrenceId(2)).name, "vise");
  }
}

}  // namespace
}  // namespace hvas::product
