#pragma once

#include <string>
#include <vector>

#include "product/product.h"

namespace hvas::product {

/** Why several occurrences of a file are one body. */
enum class WeldReason {
  kDuplicate,       ///< Parts of one shape at the same place: all but the first are left out.
  kBodiesOfPart,    ///< Bodies of one part of the file: a fastener, or a solid with its surfaces.
  kRollingBearing,  ///< Rings with balls or rollers around one axis.
  kBoughtUnit,      ///< A subassembly whose name says that it is bought as one piece.
  kComponent,       ///< The bodies of one component on a circuit board.
  kEnclosed,        ///< A part in a closed cavity of another one.
  kVariant,         ///< Parts where only one can be: all but the first are left out.
};

/** Whether the members after the first are left out, instead of being put together with it. */
[[nodiscard]] constexpr bool DoesLeaveOut(WeldReason reason) {
  return reason == WeldReason::kDuplicate || reason == WeldReason::kVariant;
}

/** Reads as the end of "is one body of 4 parts (...): ". */
[[nodiscard]] const char* ToString(WeldReason reason);

/** Occurrences that become one. */
struct Weld {
  std::vector<OccurrenceId> members;  ///< Two or more, by ascending ids.
  WeldReason reason{WeldReason::kBoughtUnit};
};

/** How a weld will be called: as the subassembly that holds its members and nothing else, or else
 as the member with the largest volume. */
struct WeldName {
  OccurrenceId anchor;  ///< The member whose frame, material and colour the body has.
  SubassemblyId node;   ///< The subassembly that it stands for; invalid: none.
  std::string name;
  std::string path;
};

/** The member with the largest volume; of members without, the one with the largest box. */
[[nodiscard]] OccurrenceId FindAnchor(const Product& product, const Weld& weld);

[[nodiscard]] WeldName FindName(const Product& product, const Weld& weld);

/** Replaces the members of each weld by one occurrence of one part, and leaves out subassemblies
 and parts that nothing is left of. The part has the frame of the anchor, the faces, triangles and
 mass of all members, and features found anew; of members without volume, beside members with one,
 the triangles are kept for display only. Duplicates and variants leave the part of the first one as
 it is. Welds
 of equal parts in equal relative poses share one part. `Occurrence::bodies` lists the members'
 paths.
 @pre No occurrence is in two welds, and the product has no mates yet. */
void ApplyWelds(const std::vector<Weld>& welds, Product* product);

}  // namespace hvas::product
