#pragma once

#include <vector>

#include "product/face_adjacency.h"
#include "product/product.h"
#include "product/rings.h"

namespace hvas::product {

/** Fillets and rounded edges: faces of up to 170 deg of a cylinder's turn, and tori, that run on
 tangentially on both sides, of a radius of at most 0.15 of the part's diagonal; with the rounded
 corners between them. Those of one radius that meet are one form. `taken`: faces that are something
 else already. */
[[nodiscard]] std::vector<Form> FindFillets(const Part& part, const FaceAdjacency& adjacency,
                                            const RingSet& set, const std::vector<Ring>& partials,
                                            const std::vector<Form>& taken);

/** Chamfers along edges: narrow flat or conical strips between two faces, at 20 to 70 deg to both.
 Those of one width that meet are one form. */
[[nodiscard]] std::vector<Form> FindEdgeChamfers(const Part& part, const FaceAdjacency& adjacency,
                                                 const std::vector<Form>& taken);

}  // namespace hvas::product
