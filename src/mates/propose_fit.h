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
  bool is_flexible{false};   ///< A cable, hose, clip, slit pin or rubber: what gives has no fit.
  bool is_toothed{false};    ///< A hub on the teeth of a shaft, such as a horn on its spline.
  bool is_rivet{false};      ///< The shaft has the name of a rivet.
  bool is_hollow{false};     ///< The shaft has a bore all along: a ring, bushing or insert.
  bool may_pass{false};  ///< A round shaft may go through a hole without a fit; a width has one.
  product::ThreadKind hole_thread{product::ThreadKind::kNone};
  product::ThreadKind shaft_thread{product::ThreadKind::kNone};
  bool is_pressed{false};  ///< The name of one part is that of a pin or a bearing.
  double engaged{0};       ///< Engaged length [m]; 0: it is not known.
};

/** Proposes a fit where the file does not give one, by the first row that holds:

 | drawn | names, shapes and threads | fit |
 |---|---|---|
 | any | nut on a screw | thread |
 | any | threaded hole, with a screw or a threaded shaft in it | thread |
 | hole not larger | nut on a rod; threaded hole | thread |
 | hole not larger | screw or threaded shaft, no nut behind it | thread |
 | hole smaller | screw | thread |
 | any | teeth on one side or both | insert |
 | hole larger | flexible (a cable, hose, clip, slit pin or rubber) | passage |
 | hole not larger | flexible | insert |
 | play of a proposed code, or less | nut or insert as the shaft | insert |
 | more play than the widest code | a shaft that may pass | passage |
 | hole not smaller | a rivet or a screw that may pass | passage |
 | core and outer diameter of a thread, over two turns | any but pins and bearings by their names |
 thread | | interference of a thread's depth, d <= 12 mm | hollow shaft | insert | | interference of
 a thread's depth, d <= 12 mm | any but pins and bearings by their names | thread | | interference
 above 1 um (radius) | none | the lightest press fit of H7/p6, r6, s6 | | equal within 1 um | any |
 H7/g6 | | clearance | any | the tightest of H7/g6, H8/f7, H9/d9, H11/c11 that may have it |

 Core and outer diameter are those of `fits::FindThreadOfPair`. An interference is of a thread's
 depth above 1.5 % of d and a fourth of that size's thread, or 10 %
 of d where there is no such size. The code is empty for threads, inserts and passages, and where
 ISO 286 has none for the size. The nominal diameter is the drawn hole's, that of the shaft for
 threads and inserts. */
[[nodiscard]] product::Fit ProposeFit(const FitEvidence& evidence);

}  // namespace hvas::mates
