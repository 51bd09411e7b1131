#pragma once

#include <map>
#include <string>
#include <vector>

#include "product/product.h"

namespace hvas::cad {

/** The step of a path that a name becomes: with a number where a sibling has it already.
 @param used  The names among the siblings so far. */
[[nodiscard]] std::string ClaimName(const std::string& name, std::map<std::string, int>* used);

/** Builds the tree of a product whose parts come from anywhere: keeps paths unique and both sides
 of each membership in step. The root is there from the start, named as the product. */
class ProductTree {
 public:
  explicit ProductTree(product::Product* product);

  product::SubassemblyId AddSubassembly(product::SubassemblyId parent, const std::string& name);
  void AddOccurrence(product::SubassemblyId parent, product::PartId part, const std::string& name,
                     const spatial::Pose& X_WB);
  /** Takes out parts without triangles with their occurrences, numbers the rest anew and measures
   the product's box. */
  void Finish();

 private:
  std::string ClaimPath(product::SubassemblyId parent, const std::string& name);

  product::Product* product_;
  std::vector<std::string> paths_;                // Of each subassembly.
  std::vector<std::map<std::string, int>> used_;  // Names among the children of each.
};

/** Takes parts out, and numbers the other parts and the occurrences anew.
 @param part_of  For each part: itself where it stays, a part that stays where that takes its place,
 or none, which takes out its occurrences too. */
void ReplaceParts(const std::vector<product::PartId>& part_of, product::Product* product);

}  // namespace hvas::cad
