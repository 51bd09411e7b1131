#pragma once

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::product {

/** Fills a part's features (layer T), forms and inner constraints from its faces and mesh; the
 rules are in docs/algorithms/features.md.

 Faces of one surface and sense that touch become one feature: holes and shafts, cone seats and
 tapers where they go far enough around their axis to hold a counterpart (FindCylinders), planes,
 sockets and balls. Order: holes and shafts, then planes, then cones, then spheres, each by their
 first face. `coverage` of a sphere is 2 pi times its share of the whole one. Threads are marked by
 helical faces, the part's name and hexagons. Inner constraints tie each feature to the part's
 references (its largest plane, its largest cylinder or cone, and the first feature on the same axis
 or centre), not all to all. Deterministic. @pre part != nullptr; its faces and mesh agree.
 @param diagnostics Gets a note ("limit-features") where a limit ended the recognition; may be null.
 */
void BuildFeatures(Part* part, Diagnostics* diagnostics = nullptr);

}  // namespace hvas::product
