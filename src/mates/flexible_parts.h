#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "mates/side_file.h"
#include "product/product.h"

namespace hvas::mates {

/** Sets the parts of a product that may give: those that are recognised
 (product::ClassifyFlexible), with the allowances that are stated over them. What is stated with an
 allowance of zero, or is among `rigid`, gets one of zero. Notes each part that is recognised.
 Errors: kNotFound for a name that nothing in the product has.
 @param rigid  Names or paths of occurrences; "all": nothing but what is stated gives. */
[[nodiscard]] Result<void> SetFlexibleParts(const std::vector<StatedFlexible>& stated,
                                            const std::vector<std::string>& rigid,
                                            product::Product* product, Diagnostics* diagnostics);

}  // namespace hvas::mates
