#pragma once

#include <string>
#include <vector>

#include "orders/hand_time.h"

namespace hvas::shopfloor {

/** A sequence of BasicMOST: "A1 B0 G1 A1 B0 P3 A0". */
struct MostSequence {
  std::string code;
  orders::MotionPurpose purpose{orders::MotionPurpose::kBring};  ///< What it is for.
  double seconds{0};                                             ///< [s]
};

/** Makes sequences of BasicMOST from the motions of a step, by the same distances, weights, sizes
 and fits. A: hand travel to 5 cm A0, within reach A1, 1 to 2 steps A3, 3 to 4 steps A6. G: light
 G1; heavy, small or jumbled G3. P: loose P1, with adjustments P3, with care or pressure P6. A tool
 is used by A1 B0 G1 A1 B0 P3 F A1 B0 P1 A0, with the least index F that lasts as long as the turns
 by MODAPTS: the table of F is its owner's and is not here. */
[[nodiscard]] std::vector<MostSequence> ListMostSequences(
    const std::vector<orders::HandMotion>& motions);

/** The sum over sequences [s]. */
[[nodiscard]] double SumSeconds(const std::vector<MostSequence>& sequences);

}  // namespace hvas::shopfloor
