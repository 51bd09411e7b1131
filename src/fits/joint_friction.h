#pragma once

#include <string>

#include "fits/materials.h"

namespace hvas::fits {

/** How a joint comes together, which decides what holds it (DIN 7190-1, 5.2 and 5.3). */
struct JoiningWay {
  bool is_shrunk{
      false};  ///< Joined by heat or cold: a transverse fit; else pressed in, longitudinal.
  bool is_oiled{false};  ///< Oiled with mineral oil; else dry.
};

/** Coefficients of an interference fit on the safe side: what is to hold has the low values, what
 is to be pressed in the high one. */
struct PressFriction {
  double in{0};       ///< mu_e: the highest value known of the pair, for the press.
  double release{0};  ///< nu_ll, along, and nu_ru, about the axis: the lowest, for what it holds.
  double slip{0};     ///< nu_rl, while it slides; no larger than `release`.
  std::string source;
  bool is_assumed{false};  ///< The table has no such pair.
};

/** Friction of a pair of materials, from the rows of JointFrictionTable(). Pressed in: release and
 slip are those of the pair's rows of DIN 7190-1, 5.2 (a steel that is not there has the lower of
 E335 and S235, a copper alloy those of G-CuPb10Sn, a light metal those of AlSi12); pressing in
 takes the highest of these and of the design values for pressed joints. Shrunk: release and slip
 are the lowest of DIN 7190-1, 5.3, of parts that are not degreased where that is stated. A pair
 without a row (none of the two is steel, plastics) has 0.05 to hold and 0.2 to press in, and says
 so. */
[[nodiscard]] PressFriction FindPressFriction(const Material& hub, const Material& shaft,
                                              const JoiningWay& way);

}  // namespace hvas::fits
