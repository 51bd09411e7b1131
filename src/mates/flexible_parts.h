#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "mates/side_file.h"
#include "product/product.h"

namespace hvas::mates {

/** Sets the parts of a product that may give: those that are recognised by their form
 (product::ClassifyFlexibleByForm), by form and place (product::ListYieldingInPlace), and where
 neither says anything by name and material, with the allowances that are stated over them. What is
 stated with an allowance of zero, or is among `rigid`, gets one of zero. Notes each part that is
 recognised. Errors: kNotFound for a name that nothing in the product has.
 @param rigid  Names or paths of occurrences; "all": nothing but what is stated gives.
 @param watch  Ends the search for forms by its limits; null: none. */
[[nodiscard]] Result<void> SetFlexibleParts(const std::vector<StatedFlexible>& stated,
                                            const std::vector<std::string>& rigid,
                                            product::Product* product, Diagnostics* diagnostics,
                                            WorkWatch* watch = nullptr);

}  // namespace hvas::mates
