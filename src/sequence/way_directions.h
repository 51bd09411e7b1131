#pragma once

#include <vector>

#include "product/product.h"

/** Directions along which a part is tried to be drawn out. */
namespace hvas::sequence {

/** Sine or cosine of an angle that counts as zero: a milliradian, ten times the deviation of mates.
 * A choice. */
inline constexpr double kParallel = 1e-3;

/** Adds a unit direction if none that is known is within a milliradian of it. */
void AddDirection(const Vec3& d, std::vector<Vec3>* directions);

/** Adds both directions along the edges of each two faces with these unit normals, of the first
 eight: out of a slot, whichever way it was drawn. */
void AddEdges(const std::vector<Vec3>& normals, std::vector<Vec3>* directions);

/** Lists the normals of the planes of a part that have most area, at most three, as lines in its
 frame: the directions in which it was drawn, however it lies in the product. */
[[nodiscard]] std::vector<Vec3> ListPlaneLines(const product::Part& part);

/** Lists directions that do not lead into any face with these unit normals, which point out of the
 faces: along the normals, between them, and along the edges of two of them, which are the edges of
 the cone of free motion. At most 24, upward ones first. */
[[nodiscard]] std::vector<Vec3> ListFreeDirections(const std::vector<Vec3>& normals);

/** Puts upward directions first, as people assemble from above. */
void SortUpwardFirst(std::vector<Vec3>* directions);

}  // namespace hvas::sequence
