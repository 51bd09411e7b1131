#pragma once

#include <string>

#include "exchange/exported_product.h"

namespace hvas::exchange {

/** A product as a model of MuJoCo (MJCF), one file, in SI, with the parts as drawn.

 | in the product | in the model |
 |---|---|
 | part in its place | a body with a free joint and its own inertia; the base is fixed |
 | display mesh | a mesh that is seen and met by nothing (group 2) |
 | CollisionForm | convex meshes and cylinders that are met (group 3) |
 | mate | a site on each of its bodies, NAME_a and NAME_b; a tuple of text with its kind and fit |
 | sizes of a mate | a numeric NAME_sizes: hole, shaft, least and largest clearance [m] |

 Parts without a mass get 0.1 g and the inertia of a ball of 1 cm. */
[[nodiscard]] std::string MakeMjcf(const ExportedProduct& exported);

}  // namespace hvas::exchange
