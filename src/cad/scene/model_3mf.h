#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "cad/scene/placed_parts.h"

namespace hvas::cad {

/** What assimp leaves out of the model part of a 3MF file (3MF core specification 1.3). */
struct Model3mf {
  double length_unit{1e-3};          ///< [m]
  bool is_unit_known{true};          ///< False where the file names one that does not exist.
  std::map<int, std::string> names;  ///< Names of objects that have one, by their ids.
  PlacedTree placed;                 ///< Objects that its build places, with their components.
};

[[nodiscard]] Model3mf ParseModel3mf(std::string_view xml);

}  // namespace hvas::cad
