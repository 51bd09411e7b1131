#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "cad/import.h"
#include "product/product.h"

class TopoDS_Face;
class TopoDS_Shape;

namespace hvas::cad {

/** How finely a shape was meshed. */
struct MeshLevel {
  double deflection{0};  ///< Largest distance of a chord from its curve [m].
  double angle{0};       ///< Largest angle between the normals of neighbouring triangles [rad].
};

/** Meshes a shape in place for the eye: to a thousandth of `diagonal` [m], which is its size, or
 coarser where that makes more than half of `options.max_triangles`. Face by face the triangles can
 be had from AppendTriangles until the shape is meshed again. */
MeshLevel MeshForDisplay(const TopoDS_Shape& shape, double diagonal, const ImportOptions& options);

/** Meshes a shape in place for contact, after MeshForDisplay, whose triangles tell how many there
 will be: on B-splines their number goes with the inverse of the deflection, and a fine mesh of the
 wrong part takes minutes. Notes a mesh coarser than wanted, and warns of one that is too large.
 Edges have the level's deflection, the inside of freeform faces twice that, and that of
 analytic ones only its angle: contact has their distances from their surfaces.
 @param is_analytic  Of each face, in the order of TopExp_Explorer.
 @pre `shape` holds the mesh of MeshForDisplay at `display`. */
MeshLevel MeshForContact(const TopoDS_Shape& shape, double diagonal, const MeshLevel& display,
                         const std::vector<bool>& is_analytic, const ImportOptions& options,
                         const std::string& name, Diagnostics* diagnostics);

[[nodiscard]] bool IsMeshed(const TopoDS_Face& face);

/** Appends a face's triangles with outward orientation, its vertices in metres; slivers without an
 area are left out. */
void AppendTriangles(const TopoDS_Face& face, product::Mesh* mesh);

/** Cuts a face that BRepMesh gives up (cones with a seam are among them) into pieces that it can
 do; of several ways the one that leaves the least undone. */
[[nodiscard]] std::vector<TopoDS_Face> MeshInPieces(const TopoDS_Face& face,
                                                    const MeshLevel& level);

}  // namespace hvas::cad
