#pragma once

#include <optional>

#include "product/ids.h"

namespace hvas::product {

/** What the user states of the contact of two parts, instead of what holds for all contacts. */
struct ContactPair {
  OccurrenceId a;
  OccurrenceId b;
  std::optional<double> compliance;  ///< Compliance of one contact point [m/N].
  std::optional<double> friction;    ///< Coulomb coefficient, static and kinetic.
};

}  // namespace hvas::product
