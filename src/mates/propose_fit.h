#pragma once

#include "product/fastener_name.h"
#include "product/product.h"

namespace hvas::mates {

using product::ClassifyName;
using product::FastenerKind;

/** What a proposal rests on: the drawn radii and the names. */
struct FitEvidence {
  double hole_radius{0};   ///< Drawn radius [m].
  double shaft_radius{0};  ///< Drawn radius [m].
  FastenerKind hole_part{FastenerKind::kNone};
  FastenerKind shaft_part{FastenerKind::kNone};
  bool nut_on_shaft{false};  ///< A nut sits on the same shaft: other holes are through holes.
  product::ThreadKind hole_thread{product::ThreadKind::kNone};
  product::ThreadKind shaft_thread{product::ThreadKind::kNone};
};

/** Proposes a fit where the file does not give one:

 | drawn | names, shapes and threads | fit |
 |---|---|---|
 | any | nut on a screw | thread |
 | any | threaded hole, with a screw or a threaded shaft in it | thread |
 | hole not larger | nut on a rod; threaded hole; screw or threaded shaft, no nut behind it | thread
 | | hole smaller | screw or nut as the shaft: screwed, melted or pulled in, never pressed | thread
 | | interference above 1.5 % of d, d <= 12 mm | any | thread | | interference above 1 um (radius) |
 none | the lightest press fit of H7/p6, H7/r6, H7/s6 | | equal within 1 um | none, or a through
 hole | H7/g6 | | clearance | any other | the tightest of H7/g6, H8/f7, H9/d9, H11/c11 that may have
 it |

 The code is empty where ISO 286 has none for the size. The nominal diameter is the drawn hole's,
 that of the shaft for threads. */
[[nodiscard]] product::Fit ProposeFit(const FitEvidence& evidence);

}  // namespace hvas::mates
