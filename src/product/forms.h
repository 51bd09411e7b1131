#pragma once

#include <vector>

#include "product/face_adjacency.h"
#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** What a machinist has a word for in a part whose features are there: holes, shafts and bosses,
 grooves, slots, pockets, seats, fillets, chamfers and patterns of holes, in this order. Rules and
 limits are in docs/algorithms/features.md; what cannot be told is left out.

 | form | origin_B | axis_B | diameter | depth | other |
 |---|---|---|---|---|---|
 | hole | on the axis at the entry | into the material | of its narrowest step | to the flat bottom
 or | count: steps; angle: countersink | | | | | | the far side, without a drill's tip | | | boss,
 shaft | on the axis at the tip | out of the material | of its widest step | length | count: steps |
 | groove | middle, on the axis | axis | of its floor | radial | |
 | slot | middle of the entry | into the material | width | | |
 | pocket | middle of the entry | into the material | - | | |
 | seat | centroid | outward normal | - | - | |
 | fillet | centre | axis of the first face | twice the radius | - | |
 | chamfer | centre | axis, or normal of the first face | - | along the axis; flat ones: width of
 the strip | angle | | pattern | centre | along the holes | bolt circle; 0 for rows and grids | - |
 count: holes |

 @param tolerance The part's own, as BuildFeatures has it [m].
 @param limits Gets the limits that were reached. */
[[nodiscard]] std::vector<Form> FindForms(const Part& part, const FaceAdjacency& adjacency,
                                          double tolerance, RecognitionLimits* limits);

}  // namespace hvas::product
