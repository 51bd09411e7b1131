#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/shape_data.h"

/** The smooth surface of freeform faces through the corners of their triangles.

 A triangle with corners A, B, C and barycentric coordinates a, b, c carries the quadratic patch

     x = a A + b B + c C - a b c_0 - b c c_1 - c a c_2

 with c_k the bend of its edge k, from corner k to corner k + 1, chosen so that the surface has the
 normals n_0, n_1 of the edge's ends there: Nagata, Computer Aided Geometric Design 22 (2005),
 327-347, who solves n_0 c = n_0 d, n_1 c = -n_1 d for an edge d. Here c lies along m, the mean of
 both normals, with the mean of both conditions: the same for even arcs, and bounded where the
 normals are nearly parallel. Neighbours share the bend of their edge, so that there is no gap. */
namespace hvas::contact {

/** Finds the bends of a mesh's triangles from its corners alone: the normal in a corner is that of
 the paraboloid through the corners around it, or of an analytic face that goes over into the
 freeform one there. None where no face is freeform, nor where the mesh is too coarse to be of a
 smooth face. Notes how far freeform faces leave their triangles.
 @param diagonal  Of the part [m].
 @param exact  Its faces, in the frame of the mesh. */
void FindBends(double diagonal, ExactTable* exact, Mesh* mesh);

/** A point of the smooth surface. */
struct CurvedPoint {
  Vec3 q{Vec3::Zero()};
  Vec3 normal{Vec3::Zero()};        ///< Unit, out of the material.
  std::uint32_t triangle{kNoFace};  ///< The triangle on whose patch it is.
  bool is_inside{false};            ///< False beyond the rim of its face.
};

/** The point of a triangle's patch at the weights of its second and third corner. RT-safe. */
[[nodiscard]] CurvedPoint PointOfPatch(const Mesh& mesh, std::uint32_t triangle, double u,
                                       double v) noexcept;

/** Where a foot is looked for: on the face of the triangle, or also on freeform faces that it goes
 over into. */
enum class FootOn : std::uint8_t { kFace, kSurface };

/** Finds the foot of p on the smooth surface: goes from a triangle of it to where the foot is.
 Beyond a rim the patch at the rim is continued for a third of its size. False where no foot is
 found. RT-safe. */
[[nodiscard]] bool FindFoot(const Mesh& mesh, std::uint32_t triangle, const Vec3& p, FootOn on,
                            CurvedPoint* foot) noexcept;

}  // namespace hvas::contact
