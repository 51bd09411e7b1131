#pragma once

#include <string_view>

#include "product/product.h"

namespace hvas::mates {

/** What the names of a part say about it. */
enum class FastenerKind { kNone, kScrew, kNut };

/** Reads names as "Screw", "bolt", "M3x16", "DIN 912", "ISO4762", "BHCS", "nut", "heat-set insert";
 nuts and threaded inserts are kNut. ASCII case does not matter. */
[[nodiscard]] FastenerKind ClassifyName(std::string_view name);

/** What a proposal rests on: the drawn radii and the names. */
struct FitEvidence {
  double hole_radius{0};   ///< As drawn [m].
  double shaft_radius{0};  ///< As drawn [m].
  FastenerKind hole_part{FastenerKind::kNone};
  FastenerKind shaft_part{FastenerKind::kNone};
  bool nut_on_shaft{false};  ///< A nut sits on the same shaft: other holes are through holes.
};

/** Proposes a fit where the file does not give one:

 | drawn | names | fit |
 |---|---|---|
 | any | nut on a screw | thread |
 | hole not larger | screw in a hole without a nut behind it, or a nut on a rod | thread |
 | interference above 1.5 % of d, d <= 12 mm | any | thread |
 | interference above 1 um (radius) | none | the lightest press fit of H7/p6, H7/r6, H7/s6 |
 | equal within 1 um | none, or a through hole | H7/g6 |
 | clearance | any other | the tightest of H7/g6, H8/f7, H9/d9, H11/c11 that may have it |

 The code is empty where ISO 286 has none for the size. The nominal diameter is the drawn hole's,
 that of the shaft for threads. */
[[nodiscard]] product::Fit ProposeFit(const FitEvidence& evidence);

}  // namespace hvas::mates
