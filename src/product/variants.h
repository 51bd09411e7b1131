#pragma once

#include <utility>
#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::product {

/** Two parts of different shape that are drawn where only one of them can be. */
struct VariantPair {
  OccurrenceId first;
  OccurrenceId second;
  double shared{0};  ///< Shared volume as a part of the smaller one's.
};

/** What two parts have of their volumes in common, in the poses as drawn. */
struct SharedVolume {
  double first{0};   ///< Volume of the first [m^3].
  double second{0};  ///< Volume of the second [m^3].
  double both{0};    ///< Shared volume [m^3].
};

/** Measures volumes by the lengths of parallel lines in the parts (Cavalieri): a few per cent for
 parts that are not much thinner than a twentieth of the larger one. Zero where a mesh is not
 closed. */
[[nodiscard]] SharedVolume CalcSharedVolume(const Product& product, OccurrenceId first,
                                            OccurrenceId second);

/** Finds variants, such as two lengths of one screw at one place: parts that share four fifths of
 the volume of both together; or four fifths of that of the smaller one, half of whose surface lies
 on equal faces of the larger one. What is drawn into the material of another part, as a screw
 in a block without a hole, shares its volume and no faces. Each second is in one pair at most, with
 the earliest first. Incomplete when the watch ends it. */
[[nodiscard]] std::vector<VariantPair> FindVariants(const Product& product,
                                                    WorkWatch* watch = nullptr);

}  // namespace hvas::product
