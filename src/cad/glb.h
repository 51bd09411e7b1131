#pragma once

#include <string>

#include "base/result.h"
#include "product/product.h"

namespace hvas::cad {

/** A product as a binary glTF 2.0 file (.glb), in metres, Y up.

 Nodes are the tree: a root that turns z up into y up, subassemblies, and occurrences with their
 poses; extras tell their ids. There is one mesh for each part, shared by its occurrences, with one
 primitive for each colour. Vertices have POSITION, NORMAL (smooth within a face) and _FACE_ID: the
 index of the face in its part, as a float, because glTF lets no such attribute be an integer.
 Deterministic.
 @param is_fine  The meshes for contact instead of those for the eye.
 Fails (kOutOfResource) above the 4 GiB that the format can hold. */
[[nodiscard]] Result<std::string> MakeGlb(const product::Product& product, bool is_fine);

}  // namespace hvas::cad
