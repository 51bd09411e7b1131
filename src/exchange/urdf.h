#pragma once

#include "base/result.h"
#include "exchange/exported_product.h"

namespace hvas::exchange {

/** A product as a robot description: NAME.urdf, and one STL file in metres for each part and each
 of its convex pieces, in NAME_meshes/. The base is the root; every other part is a link on a
 floating joint from it, in its place as drawn. Cylinders stay cylinders. What URDF has no element
 for is in <hvas:mate> elements, which other readers pass over: frames, kind, fit and sizes of each
 mate.
 @param name  Of the file, without its ending. */
[[nodiscard]] ExportedFiles MakeUrdf(const ExportedProduct& exported, const std::string& name);

}  // namespace hvas::exchange
