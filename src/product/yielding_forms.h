#pragma once

#include <optional>
#include <vector>

#include "base/work_watch.h"
#include "product/flexible.h"
#include "product/product.h"

/** Parts whose form and place together say that they give (docs/algorithms/flexible.md). */
namespace hvas::product {

/** A band that goes round several axes, open to both sides. */
struct BandShape {
  Vec3 axis_B{Vec3::UnitZ()};  ///< Unit, across the band.
  std::vector<Vec3> arcs_B;    ///< A point of the axis of each arc, one for each axis [m].
  double thickness{0};         ///< The mean along it [m].
  double length{0};            ///< Length of its middle line [m].
};

/** Measures a part as a thin band: as thick everywhere on average as its volume over its sides,
 with arcs about two axes or more. None where it is something else, as a round ring or a tray. */
[[nodiscard]] std::optional<BandShape> FindBandShape(const Part& part);

/** Lists the occurrences that give by their form and by where they are:
 - a plain closed ring in a groove of another part that it could neither be put over nor into: it
   stretches, or is a split ring that is drawn closed;
 - a thin band round shafts of other parts, about two of its axes or more: a belt.
 Sorted by occurrence, each once. @param watch  Ends the search by its limits; null: none. */
[[nodiscard]] std::vector<FlexiblePart> ListYieldingInPlace(const Product& product,
                                                            WorkWatch* watch);

}  // namespace hvas::product
