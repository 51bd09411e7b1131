#pragma once

#include <vector>

#include "haptics/held_part.h"
#include "product/product.h"

namespace hvas::sequence {

/** Faces of a mate's side and their neighbours: the faces that share an edge with them, and those
 that reach the plane of a plane one within 10 um, as the flanks of teeth that end in its corners.
 */
[[nodiscard]] haptics::MateFaces CollectMateFaces(const product::Part& part,
                                                  const std::vector<product::FaceId>& mating);

}  // namespace hvas::sequence
