#pragma once

#include <vector>

#include "product/face_adjacency.h"
#include "product/product.h"

namespace hvas::product {

/** Sockets and balls: spherical faces of one centre, radius and sense that are at least 15 % of the
 sphere. A smaller share than 40 % that runs on tangentially all around is the rounding of a corner
 and is left out. Feature::coverage is 2 pi times the share. By their first face. */
[[nodiscard]] std::vector<Feature> FindSpheres(const Part& part, const FaceAdjacency& adjacency,
                                               double tolerance);

}  // namespace hvas::product
