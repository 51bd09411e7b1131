#pragma once

#include <string>

#include "product/product.h"

namespace hvas::mates {

/** The key of a mate: 10 hex digits of its kind, the paths of its two occurrences and the geometry
 of its two features in their parts (to 1 um and 1 urad). It stays the same when the same file is
 read again, whatever other mates and features there are. @pre The mate's occurrences and features
 exist in `product`. */
[[nodiscard]] std::string CalcKey(const product::Product& product, const product::Mate& mate);

/** Sets the keys of all mates. Where two would be equal (the same geometry twice in a part), the
 later one counts on. */
void AssignKeys(product::Product* product);

}  // namespace hvas::mates
