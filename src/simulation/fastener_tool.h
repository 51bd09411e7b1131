#pragma once

#include <string>
#include <vector>

#include "product/product.h"

namespace hvas::simulation {

/** Names the tool that turns each occurrence, by the form that takes it up: "hexagon key 5 mm",
 "spanner 10 mm", "cross screwdriver", "slot screwdriver 1.2 mm"; "screwdriver" for a screw without
 a form that is recognised. Empty for what is no screw, bolt or nut. Indexed by OccurrenceId. */
[[nodiscard]] std::vector<std::string> NameTools(const product::Product& product);

}  // namespace hvas::simulation
