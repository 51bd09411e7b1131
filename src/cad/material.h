#pragma once

#include <optional>

namespace hvas::cad {

/** The density [kg/m^3] meant by a number from a CAD file, which may be in kg/m^3, g/cm^3, g/mm^3
 or kg/mm^3 whatever the file says. Empty when no unit makes it that of a solid material
 (400..23,000 kg/m^3); the ranges of the units do not overlap. */
[[nodiscard]] std::optional<double> NormaliseDensity(double value);

}  // namespace hvas::cad
