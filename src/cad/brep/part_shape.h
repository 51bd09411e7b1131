#pragma once

#include <functional>
#include <optional>

#include "base/diagnostics.h"
#include "cad/brep/cad_document.h"
#include "cad/brep/part_mesh.h"
#include "cad/import.h"
#include "product/product.h"

class TopoDS_Face;
class TopoDS_Shape;

namespace hvas::cad {

using FaceColorFn = std::function<std::optional<product::Color>(const TopoDS_Face&)>;

/** How much there is in a shape, before any work on it. */
struct ShapeContent {
  int solids{0};
  int faces{0};
  int free_curves{0};  ///< Edges that bound no face.
};

[[nodiscard]] ShapeContent CountContent(const TopoDS_Shape& shape);

/** Fills meshes, faces, box, mass, solid_count and shape_hash of a part from its B-rep; name and
 material must be there already. Closed shells count as solids where there is no solid, other faces
 outside any solid where there is neither. Colours come from `color_of`, Face::entity from
 `entity_of`. The shape loses any triangles it had. @returns how finely it was meshed, or nothing
 when nothing could be meshed. Different threads may work on shapes without common subshapes. */
[[nodiscard]] std::optional<MeshLevel> BuildPartShape(const TopoDS_Shape& shape,
                                                      const ImportOptions& options,
                                                      const FaceColorFn& color_of,
                                                      product::Part* part, Diagnostics* diagnostics,
                                                      const FaceEntityFn& entity_of = {});

}  // namespace hvas::cad
