#include "cad/product_tree.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hvas::cad {

using product::Occurrence;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Subassembly;
using product::SubassemblyId;

ProductTree::ProductTree(product::Product* product) : product_(product) {
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
  std::map<std::string, int>& used = used_[parent.index()];
  std::string step = name;
  std::replace(step.begin(), step.end(), '/', '_');
  const std::string base = step;
  for (int& count = used[base]; ++count > 1;) {
    step = fmt::format("{}#{}", base, count);
    if (used.count(step) == 0) {  // Someone may be called "nut#2" by birth.
      used[step] = 1;
      break;
    }
  }
  return paths_[parent.index()] + "/" + step;
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

void ProductTree::DropEmptyParts() {
  std::vector<Part> parts;
  std::vector<PartId> renumbered(product_->parts.size());
  for (std::size_t i = 0; i < renumbered.size(); ++i) {
    if (!product_->parts[i].mesh.triangles.empty()) {
      renumbered[i] = PartId(parts.size());
      parts.push_back(std::move(product_->parts[i]));
      parts.back().id = renumbered[i];
    }
  }
  product_->parts = std::move(parts);
  for (Subassembly& subassembly : product_->subassemblies) {
    subassembly.occurrences.clear();
  }
  std::vector<Occurrence> occurrences;
  for (Occurrence& occurrence : product_->occurrences) {
    occurrence.part = renumbered[occurrence.part.index()];
    if (occurrence.part.is_valid()) {
      occurrence.id = OccurrenceId(occurrences.size());
      product_->subassemblies[occurrence.parent.index()].occurrences.push_back(occurrence.id);
      occurrences.push_back(std::move(occurrence));
    }
  }
  product_->occurrences = std::move(occurrences);
}

void ProductTree::Finish() {
  if (std::any_of(product_->parts.begin(), product_->parts.end(),
                  [](const Part& part) { return part.mesh.triangles.empty(); })) {
    DropEmptyParts();
  }
  for (const Occurrence& occurrence : product_->occurrences) {
    for (const Vec3& vertex : product_->part_of(occurrence.id).mesh.vertices) {
      product_->box_W.Add(occurrence.X_WB * vertex);
    }
  }
}

}  // namespace hvas::cad
