#pragma once

#include <optional>
#include <string>

#include "base/diagnostics.h"
#include "product/product.h"

namespace hvas::cad {

/** The density [kg/m^3] meant by a number from a CAD file, which may be in kg/m^3, g/cm^3, g/mm^3
 or kg/mm^3 whatever the file says. Empty when no unit makes it that of a solid material
 (400..23,000 kg/m^3); the ranges of the units do not overlap. */
[[nodiscard]] std::optional<double> NormaliseDensity(double value);

/** A material as a file states it. */
struct StatedMaterial {
  std::string name;
  double density{0};  ///< Any unit; 0 where there is none.
};

/** The material of a part, from what the file states: by its name in fits::Materials(); else by its
 density; else structural steel. A density that is missing or absurd is that of the row, and noted
 as assumed. */
[[nodiscard]] product::Material MakeMaterial(const std::optional<StatedMaterial>& stated,
                                             const std::string& part_name,
                                             Diagnostics* diagnostics);

}  // namespace hvas::cad
