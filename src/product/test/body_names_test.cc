#include "product/body_names.h"

#include <gtest/gtest.h>

namespace hvas::product {
namespace {

SubassemblyId AddSubassembly(Product* product, const std::string& name) {
  Subassembly subassembly;
  subassembly.id = SubassemblyId(product->subassemblies.size());
  subassembly.name = name;
  product->subassemblies.push_back(subassembly);
  return subassembly.id;
}

void AddOccurrence(Product* product, SubassemblyId parent, PartId part) {
  Occurrence occurrence;
  occurrence.id = OccurrenceId(product->occurrences.size());
  occurrence.part = part;
  occurrence.parent = parent;
  product->subassemblies[parent.index()].occurrences.push_back(occurrence.id);
  product->occurrences.push_back(occurrence);
}

/** Two parts called SOLID: one in each of `first`, the other in a subassembly with a second body.
 */
Product MakeProduct(const std::vector<std::string>& first) {
  Product product;
  product.parts.resize(3);
  product.parts[0].name = "SOLID";
  product.parts[1].name = "SOLID";
  product.parts[2].name = "lever";
  for (const std::string& name : first) {
    AddOccurrence(&product, AddSubassembly(&product, name), PartId(0));
  }
  const SubassemblyId two = AddSubassembly(&product, "two bodies");
  AddOccurrence(&product, two, PartId(1));
  AddOccurrence(&product, two, PartId(2));
  return product;
}

TEST(BodyNames, ASoleBodyHasTheNameOfItsSubassembly) {
  Product product = MakeProduct({"BOLT", "BOLT"});
  NameSoleBodies(&product);
  EXPECT_EQ(product.parts[0].name, "BOLT");
  EXPECT_EQ(product.parts[1].name, "SOLID");
  EXPECT_EQ(product.parts[2].name, "lever");
}

TEST(BodyNames, ABodyOfSeveralNamesAndOneInANamelessSubassemblyStay) {
  Product several = MakeProduct({"BOLT", "SCREW", "BOLT"});
  NameSoleBodies(&several);
  EXPECT_EQ(several.parts[0].name, "SOLID");
  Product nameless = MakeProduct({"COMPOUND"});
  NameSoleBodies(&nameless);
  EXPECT_EQ(nameless.parts[0].name, "SOLID");
}

}  // namespace
}  // namespace hvas::product
