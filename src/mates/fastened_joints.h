#pragma once

#include <optional>
#include <vector>

#include "product/product.h"

namespace hvas::mates {

/** Two parts that screws, bolts or pins on parallel axes hold together: their holes, and the
 fasteners in them, are one joint. */
struct FastenedJoint {
  product::OccurrenceId a;  ///< The first in the file.
  product::OccurrenceId b;
  std::vector<product::OccurrenceId> fasteners;  ///< Each is mated with a hole of both parts.
  double diameter{0};  ///< Drawn diameter of the fasteners [m]; the largest where they differ.
  /** Diameter of the circle through the fasteners [m], about the pilot where there is one, else
   about their mean; 0 for one fastener, and where they are not on one circle. */
  double circle_diameter{0};
  std::optional<product::MateId> pilot;  ///< Axis-hole mate of a and b parallel to the fasteners.
  /** How far the fasteners' axes are from those of their holes in the two parts, at most [m]:
   patterns that do not meet exactly. */
  double offset{0};
  int free_translations{0};  ///< Freedom of b on a, the fasteners as pins: 0..3.
  int free_rotations{0};     ///< 0..3
};

/** Finds them from the mates, by pairs of parts and directions of axes, in the order of the pairs.
 A fastener goes through or into two parts or more that are no nuts; each two next to each other
 along its axis are joined, also where it is off the axes of their holes. One that no name or shape
 calls a screw counts where there are two or more of them: a shaft in two bearings is none. The
 freedom is that which the mates of the pair and the axes of the fasteners leave
 (`CalcFreeTwists`). */
[[nodiscard]] std::vector<FastenedJoint> FindFastenedJoints(const product::Product& product);

}  // namespace hvas::mates
