#pragma once

#include <vector>

#include "cad/triangles/welded_mesh.h"

/** Cracks of a mesh: vertices of one face that lie on an edge of another one, whose triangles do
 not have them (T-junctions). */
namespace hvas::cad {

/** Keeps the triangles that are not marked; what follows from triangles is to be found again. */
void DropTriangles(const std::vector<bool>& is_dropped, WeldedMesh* mesh);

/** Divides triangles at the vertices of others that lie on their open edges, on one edge of each
 triangle. Up to 50,000 vertices of open edges are looked at.
 @param mesh  Its neighbours are known, and are to be found again. @returns false where none is. */
bool DivideCracked(WeldedMesh* mesh);

}  // namespace hvas::cad
