#pragma once

#include "product/product.h"

namespace hvas::product {

/** Whether every index in a product leads to something, ids are places in their lists, triangles
 lie in their meshes, and the subassemblies are one tree whose parents come before their children.
 Mates and hints may lack a feature or a face, but may not have one that is not there. */
[[nodiscard]] bool Validate(const Product& product);

}  // namespace hvas::product
