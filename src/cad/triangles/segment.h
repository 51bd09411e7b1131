#pragma once

#include <cstdint>
#include <vector>

#include "cad/triangles/welded_mesh.h"

namespace hvas::cad {

/** Triangles that make one face. */
struct Segment {
  spatial::Surface surface;              ///< Freeform where nothing fits; with outward sense.
  double residual{0};                    ///< Largest distance of its corners from the surface [m].
  std::vector<std::uint32_t> triangles;  ///< Rising.
  std::vector<std::uint32_t> corners;    ///< Vertices that it was fitted to; rising.
  std::uint32_t given{kNoTriangle};      ///< The face of the file it is part of, if any.
  bool is_given_surface{false};          ///< The file states the surface itself.
  double tolerance{0};                   ///< The tolerance with which it was found [m].
};

/** Parts the triangles of a mesh into faces: planes, cylinders, cones, spheres, tori, and freeform
 faces of what is left. docs/algorithms/segmentation.md has the method and its limits.

 The corners of a tessellated CAD face lie on the face: surfaces are fitted to corners, and what
 counts is how many triangles one surface explains within the tolerance, which starts at the
 resolution of the file and rises tenfold twice. Faces that the file states are kept apart; their
 surfaces are taken where the triangles lie on them.
 Every triangle is in one segment; segments are ordered by their first triangle. Deterministic.
 @param given  Of each triangle, index into `faces`; kNoTriangle or empty: none. */
[[nodiscard]] std::vector<Segment> SegmentMesh(const WeldedMesh& mesh,
                                               const std::vector<std::uint32_t>& given,
                                               const std::vector<TriangleSoup::GivenFace>& faces);

}  // namespace hvas::cad
