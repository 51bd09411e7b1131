#pragma once

#include <optional>

#include "product/mate.h"

namespace hvas::exchange {

/** The sizes of a hole and a shaft that a model for another program is made with. Diameters, or
 widths of a prismatic mate [m]. */
struct MateSizes {
  double hole{0};
  double shaft{0};
  double min_clearance{0};  ///< That the fit allows; where there is none, that of the two sizes.
  double max_clearance{0};

  [[nodiscard]] double clearance() const { return hole - shaft; }
};

/** The sizes of an axis-hole or prismatic mate: measured ones, else the middle of what the classes
 of its fit allow, else as drawn. None for other mates, and for threads, whose drawn diameters say
 little. */
[[nodiscard]] std::optional<MateSizes> CalcMateSizes(const product::Mate& mate);

}  // namespace hvas::exchange
