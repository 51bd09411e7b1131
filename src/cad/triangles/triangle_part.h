#pragma once

#include "base/diagnostics.h"
#include "cad/triangles/welded_mesh.h"
#include "product/product.h"

namespace hvas::cad {

/** Fills a part from triangles alone: mesh grouped by faces, faces with the surfaces that fit their
 corners (Face::is_recognised, Face::residual), mass by the divergence theorem from closed shells,
 box, features and shape_hash; has_brep becomes false. Name and material must be there already.
 What is odd about the mesh goes to `diagnostics`. @returns false where no triangle is left. */
[[nodiscard]] bool BuildTrianglePart(const TriangleSoup& soup, product::Part* part,
                                     Diagnostics* diagnostics);

}  // namespace hvas::cad
