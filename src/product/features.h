#pragma once

#include "product/product.h"

namespace hvas::product {

/** Fills a part's features (layer T) and inner constraints from its faces and mesh.

 Cylindrical faces of one axis, radius and sense whose axial spans touch become one hole or shaft,
 kept when they cover at least 200 degrees of the turn. Flat faces of one plane and normal become
 one plane. Order: holes and shafts, then planes, each by their first face. Inner constraints tie
 each feature to the part's references (its largest plane, its largest cylinder, and the first
 feature on the same axis), not all to all. Deterministic. @pre part != nullptr. */
void BuildFeatures(Part* part);

}  // namespace hvas::product
