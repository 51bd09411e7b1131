#pragma once

#include <string>
#include <vector>

#include "drawing.h"

namespace hvas::products {

/** Name of a placed part in the truth and side files: its own where that is unique in the product,
 * else its path. */
[[nodiscard]] std::vector<std::string> ReferenceNames(const std::vector<PlacedPart>& placed);

/** What a reader of the STEP file should find, as JSON. */
[[nodiscard]] std::string WriteTruth(const Drawing& drawing);

/** The side file with the fits that the designer assigned, as JSON. */
[[nodiscard]] std::string WriteAssignments(const Drawing& drawing);

/** Writes NAME.step, NAME.truth.json and NAME.hvas.json into `folder`. Throws std::exception. */
void WriteProduct(const Drawing& drawing, const std::string& folder);

}  // namespace hvas::products
