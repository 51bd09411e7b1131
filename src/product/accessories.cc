#include "product/accessories.h"

#include <algorithm>
#include <string>

namespace hvas::product {
namespace {

const Subassembly* FindHolder(const Product& product, AccessoryKind kind) {
  const auto found = std::find_if(
      product.subassemblies.begin(), product.subassemblies.end(), [kind](const Subassembly& node) {
        return node.name == ToString(kind) && node.parent == SubassemblyId(0);
      });
  return found == product.subassemblies.end() ? nullptr : &*found;
}

SubassemblyId MakeHolder(AccessoryKind kind, Product* product) {
  if (const Subassembly* holder = FindHolder(*product, kind)) {
    return holder->id;
  }
  Subassembly node;
  node.id = SubassemblyId(product->subassemblies.size());
  node.parent = SubassemblyId(0);
  node.name = ToString(kind);
  product->subassemblies.front().subassemblies.push_back(node.id);
  product->subassemblies.push_back(std::move(node));
  return product->subassemblies.back().id;
}

std::string MakePath(const Product& product, const std::string& wanted) {
  const auto is_taken = [&product](const std::string& path) {
    return std::any_of(product.occurrences.begin(), product.occurrences.end(),
                       [&path](const Occurrence& occurrence) { return occurrence.path == path; });
  };
  std::string path = wanted;
  for (int number = 2; is_taken(path); ++number) {
    path = wanted + "#" + std::to_string(number);
  }
  return path;
}

}  // namespace

const char* ToString(AccessoryKind kind) {
  static constexpr const char* kNames[] = {"workshop tools", "workshop fixtures", "workshop bench"};
  return kNames[static_cast<std::size_t>(kind)];
}

void AddAccessory(const Product& accessory, AccessoryKind kind, const Pose& X_WA,
                  Product* product) {
  const SubassemblyId holder = MakeHolder(kind, product);
  const std::size_t first_part = product->parts.size();
  for (const Part& part : accessory.parts) {
    product->parts.push_back(part);
    product->parts.back().id = PartId(product->parts.size() - 1);
  }
  for (const Occurrence& one : accessory.occurrences) {
    Occurrence occurrence = one;
    occurrence.id = OccurrenceId(product->occurrences.size());
    occurrence.part = PartId(first_part + one.part.index());
    occurrence.parent = holder;
    occurrence.path = MakePath(*product, std::string(ToString(kind)) + "/" + one.name);
    occurrence.X_WB = X_WA * one.X_WB;
    product->subassemblies[holder.index()].occurrences.push_back(occurrence.id);
    product->occurrences.push_back(std::move(occurrence));
  }
}

std::vector<OccurrenceId> ListAccessories(const Product& product, AccessoryKind kind) {
  const Subassembly* holder = FindHolder(product, kind);
  return holder == nullptr ? std::vector<OccurrenceId>() : holder->occurrences;
}

}  // namespace hvas::product
