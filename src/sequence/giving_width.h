#pragma once

#include "product/product.h"
#include "spatial/pose.h"

namespace hvas::sequence {

/** How far one of two parts has to give sideways, so that the first can move straight out along a
 way [m]: the width of what the two block of one another, seen along the way. A hook blocks a strip
 as wide as its undercut, a ring a ring as wide as the land that it passes, and a part that would
 have to go through a wall blocks its whole outline. Twice the radius of the largest circle in what
 is blocked, on a grid: good to two cells and 8 %. A cell is a tenth of `limit`, or more where 600
 of them fill the outline.
 @param way_W  Unit. @param limit  The width that matters [m], > 0. */
[[nodiscard]] double CalcGivingWidth(const product::Product& product, product::OccurrenceId moving,
                                     product::OccurrenceId other, const Vec3& way_W, double limit);

}  // namespace hvas::sequence
