#pragma once

#include <filesystem>
#include <string_view>

#include "base/result.h"
#include "product/product.h"

/** Fits that somebody states, over those that inference proposes: CAD files rarely carry them. */
namespace hvas::mates {

/** Where a STEP file's fits are looked for: "pump.step" has "pump.hvas.json" beside it. */
[[nodiscard]] std::filesystem::path FindAssignmentFile(const std::filesystem::path& product_file);

/** Reads a side file and sets the fits of the axis-hole mates that it names:

     {"format": "hvas-assignments-1",
      "fits": [{"hole": "housing", "shaft": "dowel pin 1", "diameter_mm": 6, "fit": "H7/k6"}]}

 hole and shaft are names of occurrences, or their paths or ends of paths ("tier 1/post 1") where
 names repeat; an entry applies to all
 mates between occurrences of these names whose hole or shaft has the diameter within 1 % (any, when
 diameter_mm is left out). "fit" is an ISO 286 code, or "thread".
 Errors name the file, the entry and a remedy; then no fit is changed. @returns how many mates got
 a fit. @pre product has its mates. */
[[nodiscard]] Result<int> ApplyAssignments(const std::filesystem::path& file,
                                           product::Product* product);

/** Sets fits from the command line: "AXIS=H7/p6", with AXIS a mate ("m12"), "all", or the name or
 path of an occurrence with the hole or the shaft. "all" and names leave threads as they are. The
 nominal diameter stays. Fails where AXIS names no axis-hole mate, or the size has no such fit. */
[[nodiscard]] Result<void> AssignFit(product::Product* product, std::string_view assignment);

}  // namespace hvas::mates
