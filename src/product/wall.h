#pragma once

#include <optional>

#include "product/product.h"

namespace hvas::product {

/** Calculates how thick a part is at its thinnest wall [m]: the least distance, straight into the
 material, from a face to one that looks the opposite way (within 25 degrees, so that edges and
 wedges are no walls). Looks from the three largest triangles of each face, of 2,000 faces at most:
 the ones with the most area. None where no wall is found.
 This is the measure of Shapira, Shamir and Cohen-Or, Consistent mesh partitioning and
 skeletonisation using the shape diameter function, The Visual Computer 24, 2008, with one ray. */
[[nodiscard]] std::optional<double> CalcThinnestWall(const Part& part);

/** The extent of a part along a direction [m]. @param along_B  Unit. */
[[nodiscard]] double CalcExtentAlong(const Part& part, const Vec3& along_B);

}  // namespace hvas::product
