#pragma once

#include <optional>
#include <string>
#include <vector>

#include "product/drive_forms.h"
#include "product/product.h"

namespace hvas::orders {

/** What turns a screw, bolt or nut. */
struct FastenerTool {
  std::string name;  ///< Its name (NameTools); empty for what is none of these.
  std::optional<product::DriveForm> drive;  ///< The form that takes it up, where one is recognised.
};

/** Finds the tool of each occurrence. Indexed by OccurrenceId. */
[[nodiscard]] std::vector<FastenerTool> FindTools(const product::Product& product);

/** Names the tool that turns each occurrence, by the form that takes it up: "hexagon key 5 mm",
 "spanner 10 mm", "cross screwdriver", "slot screwdriver 1.2 mm"; "screwdriver" for a screw without
 a form that is recognised. Empty for what is no screw, bolt or nut. Indexed by OccurrenceId. */
[[nodiscard]] std::vector<std::string> NameTools(const product::Product& product);

}  // namespace hvas::orders
