#include "product/body_names.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace hvas::product {
namespace {

/** Names that OpenCASCADE gives to shapes without one. */
constexpr std::array<std::string_view, 5> kKindsOfShapes{"SOLID", "COMPOUND", "COMPSOLID", "SHELL",
                                                         "FACE"};

bool IsKindOfShape(std::string_view name) {
  return std::find(kKindsOfShapes.begin(), kKindsOfShapes.end(), name) != kKindsOfShapes.end();
}

/** Name of the subassembly whose sole part an occurrence is; empty where there is none. */
std::string FindName(const Product& product, const Occurrence& occurrence) {
  const Subassembly& parent = product.subassemblies[occurrence.parent.index()];
  const bool is_sole = parent.occurrences.size() == 1 && parent.subassemblies.empty();
  return is_sole && !IsKindOfShape(parent.name) ? parent.name : std::string();
}

}  // namespace

void NameSoleBodies(Product* product) {
  std::vector<std::string> names(product->parts.size());
  std::vector<bool> is_open(product->parts.size(), true);
  for (const Occurrence& occurrence : product->occurrences) {
    const std::size_t part = occurrence.part.index();
    const std::string name = FindName(*product, occurrence);
    is_open[part] = is_open[part] && !name.empty() && (names[part].empty() || names[part] == name);
    names[part] = name;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    Part& part = product->parts[i];
    if (is_open[i] && !names[i].empty() && IsKindOfShape(part.name)) {
      part.name = names[i];
    }
  }
}

}  // namespace hvas::product
