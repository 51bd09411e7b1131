#pragma once

#include <cstddef>

#include "product/product.h"

/** Prismatic mates: two opposed faces of one part between two of another, as slot and tongue,
 pocket and block, sandwich, dovetail, polygon, key. ISO 286-1 treats the two widths as hole and
 shaft
 ("two parallel opposite surfaces"). */
namespace hvas::mates {

/** Makes prismatic mates of walls: of the face-face mates from number `first` on, which are all of
 one pair of parts. Two of them become one where the faces of one part face each other, the faces of
 the other part lie between them, and no further such wall stands between. Normals are opposed
 within 0.1 deg; or by 117 deg or more, where a third face keeps the inner part from leaving between
 the flanks (dovetail). The way out is, of the directions along the walls in which the outer part
 leaves the inner one free, the one with the shortest engagement. Gives each its proposed fit. */
void JoinWalls(product::Product* product, std::size_t first);

/** Copies a prismatic mate with another way: the frames are turned about z until x points along
 `way_W` (without its part across), and spans, engaged length and breadth are those along it. */
[[nodiscard]] product::Mate TurnToWay(const product::Product& product, const product::Mate& mate,
                                      const Vec3& way_W);

/** Chamfer or rounding that leads in. */
struct LeadIn {
  double angle{0};  ///< Angle to the way [rad]; 0: a sharp edge.
  double width{0};  ///< Width across the way, on each side [m].
};

/** The lead-in of a prismatic mate along its way: at the tongue's inner end, or else at the mouth
 of the slot. A rounding counts as a chamfer of 45 deg. */
[[nodiscard]] LeadIn FindLeadIn(const product::Product& product, const product::Mate& mate);

/** Thickness of the outer part behind both of its walls, summed [m]. */
[[nodiscard]] double CalcWallThickness(const product::Product& product, const product::Mate& mate);

/** How far the middle of the inner part is drawn from the middle of the slot, along z of the mate
 [m]. */
[[nodiscard]] double CalcDrawnShift(const product::Product& product, const product::Mate& mate);

}  // namespace hvas::mates
