#pragma once

#include "base/diagnostics.h"
#include "cad/import.h"
#include "product/product.h"

class TopoDS_Shape;

namespace hvas::cad {

/** Fills meshes, faces, box and shape_hash of a part that has curves and no faces: each curve is a
 thin closed tube, so that it is seen, and a freeform face. The part has no solid and no mass:
 warning `curves-only`. @returns whether there is anything to see. */
[[nodiscard]] bool BuildCurvePart(const TopoDS_Shape& shape, const ImportOptions& options,
                                  product::Part* part, Diagnostics* diagnostics);

}  // namespace hvas::cad
