#include "cad/scene/product_tree.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hvas::cad {

using product::Occurrence;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using product::Subassembly;
using product::SubassemblyId;

std::string ClaimName(const std::string& name, std::map<std::string, int>* used) {
  std::string step = name;
  std::replace(step.begin(), step.end(), '/', '_');
  const std::string base = step;
  for (int& count = (*used)[base]; ++count > 1;) {
    step = fmt::format("{}#{}", base, count);
    if (used->count(step) == 0) {  // Someone may be called "nut#2" by birth.
      (*used)[step] = 1;
      break;
    }
  }
  return step;
}

ProductTree::ProductTree(Product* product) : product_(product) {
  AddSubassembly({}, product->name);
}

SubassemblyId ProductTree::AddSubassembly(SubassemblyId parent, const std::string& name) {
  const SubassemblyId id(product_->subassemblies.size());
  Subassembly subassembly;
  subassembly.id = id;
  subassembly.parent = parent;
  subassembly.name = name;
  paths_.push_back(parent.is_valid() ? ClaimPath(parent, name) : name);
  used_.emplace_back();
  product_->subassemblies.push_back(std::move(subassembly));
  if (parent.is_valid()) {
    product_->subassemblies[parent.index()].subassemblies.push_back(id);
  }
  return id;
}

std::string ProductTree::ClaimPath(SubassemblyId parent, const std::string& name) {
  return paths_[parent.index()] + "/" + ClaimName(name, &used_[parent.index()]);
}

void ProductTree::AddOccurrence(SubassemblyId parent, PartId part, const std::string& name,
                                const spatial::Pose& X_WB) {
  Occurrence occurrence;
  occurrence.id = OccurrenceId(product_->occurrences.size());
  occurrence.part = part;
  occurrence.parent = parent;
  occurrence.name = name;
  occurrence.path = ClaimPath(parent, name);
  occurrence.X_WB = X_WB;
  product_->subassemblies[parent.index()].occurrences.push_back(occurrence.id);
  product_->occurrences.push_back(std::move(occurrence));
}

void ProductTree::Finish() {
  std::vector<PartId> part_of;
  for (const Part& part : product_->parts) {
    part_of.push_back(part.mesh.triangles.empty() ? PartId() : PartId(part_of.size()));
  }
  ReplaceParts(part_of, product_);
  for (const Occurrence& occurrence : product_->occurrences) {
    for (const Vec3& vertex : product_->part_of(occurrence.id).mesh.vertices) {
      product_->box_W.Add(occurrence.X_WB * vertex);
    }
  }
}

void ReplaceParts(const std::vector<PartId>& part_of, Product* product) {
  std::vector<Part> parts;
  std::vector<PartId> renumbered(part_of.size());
  for (std::size_t i = 0; i < part_of.size(); ++i) {
    if (part_of[i] == PartId(i)) {
      renumbered[i] = PartId(parts.size());
      parts.push_back(std::move(product->parts[i]));
      parts.back().id = renumbered[i];
    }
  }
  product->parts = std::move(parts);
  for (Subassembly& subassembly : product->subassemblies) {
    subassembly.occurrences.clear();
  }
  std::vector<Occurrence> occurrences;
  for (Occurrence& occurrence : product->occurrences) {
    const PartId part = part_of[occurrence.part.index()];
    if (part.is_valid()) {
      occurrence.part = renumbered[part.index()];
      occurrence.id = OccurrenceId(occurrences.size());
      product->subassemblies[occurrence.parent.index()].occurrences.push_back(occurrence.id);
      occurrences.push_back(std::move(occurrence));
    }
  }
  product->occurrences = std::move(occurrences);
}

}  // namespace hvas::cad
