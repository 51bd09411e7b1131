#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "product/product.h"
#include "product/weld.h"

namespace hvas::product {

/** What a user wants to stay apart: a unit or one of its members. */
struct KeptApart {
  std::string name;   ///< Name, path or end of a path; "all": everything.
  std::string where;  ///< Where the user says so, for the message; empty: the product's file.
};

/** Finds what cannot come apart, or is one thing drawn in pieces (docs/algorithms/units.md), in
 this order: components of circuit boards, subassemblies with the name of a bought unit,
 rolling bearings, bodies of one part, enclosed parts. No occurrence is in two of them;
 deterministic. Incomplete when the watch ends it. */
[[nodiscard]] std::vector<Weld> FindWelds(const Product& product,
                                          const std::vector<KeptApart>& apart,
                                          WorkWatch* watch = nullptr);

/** Finds duplicates alone: the later ones are to be left out. */
[[nodiscard]] std::vector<Weld> FindDuplicates(const Product& product,
                                               const std::vector<KeptApart>& apart);

/** Makes one occurrence of each unit that FindDuplicates(), FindVariants() and FindWelds() find,
 and reports it: "duplicate-part", "variant-part" (a warning) and "welded-unit", one note for each
 unit and those equal to it. Errors: kInvalid for a name in `apart` that nothing in the product has;
 those of the watch.
 @pre The product has no mates yet. */
[[nodiscard]] Result<void> WeldUnits(const std::vector<KeptApart>& apart, Product* product,
                                     Diagnostics* diagnostics, WorkWatch* watch = nullptr);

/** True for a name, a path, and the end of a path ("tier 1/post 1"). */
[[nodiscard]] bool IsCalledByPath(const std::string& name, const std::string& path,
                                  std::string_view wanted);

}  // namespace hvas::product
