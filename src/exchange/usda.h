#pragma once

#include <string>

#include "exchange/exported_product.h"

namespace hvas::exchange {

/** A product as a USD stage in text (.usda), Z up, in metres and kilograms.

 Each part is a prototype with its display mesh and its convex pieces, which are guides with
 PhysicsCollisionAPI and the approximation convexHull; each occurrence is an instance in its place
 with PhysicsRigidBodyAPI and PhysicsMassAPI, the base kinematic. A mate is an Xform in the world
 with its kind, fit, parts and sizes [m] as custom attributes in the namespace `hvas`. */
[[nodiscard]] std::string MakeUsda(const ExportedProduct& exported);

}  // namespace hvas::exchange
