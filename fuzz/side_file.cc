// NAME.hvas.json: read, and applied to a product with a mate.
#include "mates/side_file.h"

#include "fuzz/target.h"
#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::fuzz {
namespace {

product::Product MakeProduct() {
  product::Product product;
  const std::vector<std::pair<const char*, product::FeatureKind>> parts{
      {"plate", product::FeatureKind::kHole}, {"pin", product::FeatureKind::kShaft}};
  for (const auto& [name, kind] : parts) {
    product::Part part;
    part.id = product::PartId(product.parts.size());
    part.name = name;
    mates::testing::AddCylinder(&part, kind, Vec3::Zero(), Vec3::UnitZ(), 3e-3, 0, 10e-3);
    product::Occurrence occurrence;
    occurrence.id = product::OccurrenceId(product.parts.size());
    occurrence.part = part.id;
    occurrence.parent = product::SubassemblyId(0);
    occurrence.name = name;
    occurrence.path = std::string("product/") + name;
    product.parts.push_back(std::move(part));
    product.occurrences.push_back(std::move(occurrence));
  }
  product::Subassembly root;
  root.id = product::SubassemblyId(0);
  root.occurrences = {product::OccurrenceId(0), product::OccurrenceId(1)};
  product.subassemblies.push_back(root);
  Diagnostics diagnostics;
  mates::Infer(&product, &diagnostics);
  return product;
}

}  // namespace

void TestOne(std::string_view bytes) {
  const auto file = mates::ParseSideFile(bytes, "fuzz.hvas.json");
  if (!file) {
    Check(!file.error().message.empty() && !file.error().where.empty());
    return;
  }
  product::Product product = MakeProduct();
  Check(product.mates.size() == 1);
  const auto changes = mates::ApplySideFile(*file, &product);
  if (!changes) {
    Check(!changes.error().message.empty() && product.mates.size() == 1);
  }
}

}  // namespace hvas::fuzz
