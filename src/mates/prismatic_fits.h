#pragma once

#include <vector>

#include "product/product.h"

namespace hvas::mates {

/** Two parallel faces of one part between two of another: slot and tongue, pocket and block,
 recess, sandwich, key. ISO 286-1 treats them as hole and shaft ("two parallel opposite surfaces").
 */
struct PrismaticFit {
  product::OccurrenceId outer;  ///< Has the slot.
  product::OccurrenceId inner;  ///< Has the tongue.
  product::MateId low, high;    ///< The face-face mates at its two walls, along `across_W`.
  Vec3 across_W{Vec3::UnitX()};
  double outer_width{0};  ///< Drawn width [m].
  double inner_width{0};  ///< Drawn width [m].
  double engaged{0};      ///< Overlap of the smaller of its two walls [m^2].
  product::Fit fit;       ///< Proposed from the drawn widths; `nominal_diameter` is the width [m].

  [[nodiscard]] double clearance() const { return outer_width - inner_width; }
};

/** The prismatic fits among the face-face mates, by outer and inner part: walls of one part that
 face each other, each mated with a face of one other part, without a further such wall between
 them. */
[[nodiscard]] std::vector<PrismaticFit> FindPrismaticFits(const product::Product& product);

}  // namespace hvas::mates
