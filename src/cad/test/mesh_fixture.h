#pragma once

#include <cstddef>
#include <vector>

#include "base/random.h"
#include "cad/triangles/welded_mesh.h"

class TopoDS_Shape;

/** Triangles of known shapes, with corners on the true surfaces. */
namespace hvas::cad::testing {

struct ProfilePoint {
  double r{0};
  double z{0};
};

/** Appends an arc of a profile, both ends included, by angle from +r to +z. */
void AddArc(const ProfilePoint& centre, double radius, double from, double to, int steps,
            std::vector<ProfilePoint>* profile);

/** Turns a profile about z. Points on the axis become apexes. Outward when the profile has the
 material on its left, seen with r to the right and z up.
 @param is_loop  Joins the last point to the first. */
[[nodiscard]] TriangleSoup Revolve(const std::vector<ProfilePoint>& profile, int segments,
                                   bool is_loop = false);

[[nodiscard]] TriangleSoup MakeBox(const Vec3& size);

/** The triangles of a B-rep as OpenCASCADE meshes it; no two share a vertex, as in an STL file. */
[[nodiscard]] TriangleSoup MeshOf(const TopoDS_Shape& shape, double deflection_mm, double angle);

void Append(const TriangleSoup& other, TriangleSoup* soup);
void Move(const spatial::Pose& X_AB, TriangleSoup* soup);
/** Rounds the coordinates to single precision, counted in millimetres. */
void RoundToFloat(TriangleSoup* soup);
/** Moves each vertex by a normal deviation in each direction [m]. */
void Shake(double deviation, Random* random, TriangleSoup* soup);
/** Divides each triangle into four, so that most vertices lie on chords. */
[[nodiscard]] TriangleSoup Subdivide(const TriangleSoup& soup);

}  // namespace hvas::cad::testing
