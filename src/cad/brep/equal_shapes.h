#pragma once

#include <cstddef>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "spatial/pose.h"

namespace hvas::cad {

/** Which shape another one is, moved. */
struct EqualShape {
  std::size_t base{0};  ///< The first shape of this form; the shape's own index where it is that.
  spatial::Pose X_SB;   ///< Takes the base's coordinates to the shape's [m].
};

/** Finds shapes that are rigid copies of earlier ones, as programs write them that do not share
 parts: in frames of their own, or moved into the product's coordinates. Mirror images are not
 copies.

 Shapes are compared when they have the same numbers of faces of each kind, edges and vertices, and
 points of the same moments; equal are those whose vertices, edges and faces correspond in the order
 of the file, all points within a micrometre (or 1e-6 of the size, if that is more) after the motion
 that fits the points best (Kabsch 1976), and every face on the same surface, with the same side
 out. Copies whose faces are written in another order are not found. Equal shapes have the same
 faces in the same order. @returns One for each shape. Null shapes equal none. */
[[nodiscard]] std::vector<EqualShape> FindEqualShapes(const std::vector<TopoDS_Shape>& shapes);

}  // namespace hvas::cad
