#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/work_watch.h"
#include "product/polygons.h"
#include "product/product.h"

/** Fits that do not turn: flats of one part around those of another. */
namespace hvas::mates {

/** A pocket or bore with flats around an axis, and the part whose flats are in it. */
struct PolygonFit {
  product::OccurrenceId outer;
  product::PolygonForm form;                   ///< Form of the outer part, in its frame.
  std::optional<product::OccurrenceId> inner;  ///< None where no part of the product is in it.
  double inner_width{0};                       ///< [m]; 0 without an inner part.
  double engaged{0};                           ///< Length along the axis that both have [m].
  std::vector<product::MateId> mates;          ///< Prismatic mates of the two parts on these flats.
};

/** Finds them by the polygons of the parts: hexagonal pockets for nuts, square, hexagonal and D
 bores, splines. Sockets in the heads of screws are none: they are for tools. What no part is in is
 listed as far as it cannot be anything else: hexagons, D forms, splines, and squares in something
 round. In the order of the outer parts and their faces. */
[[nodiscard]] std::vector<PolygonFit> FindPolygonFits(const product::Product& product,
                                                      WorkWatch* watch = nullptr);

/** What a pocket or bore is: "hexagonal pocket", "square bore", "D bore", "splined bore with 6
 teeth". */
[[nodiscard]] std::string DescribePolygon(const product::PolygonForm& form);

}  // namespace hvas::mates
