#pragma once

#include <nlohmann/json_fwd.hpp>

#include "product/product.h"

namespace hvas::app {

/** A side file that says what a product has anyway, for people to change: an entry for each
 axis-hole mate with a fit, by key, those of equal parts and fits behind each other, with notes that
 say which parts these are and which fits are only proposed. */
[[nodiscard]] nlohmann::ordered_json MakeFirstAssignments(const product::Product& product);

}  // namespace hvas::app
