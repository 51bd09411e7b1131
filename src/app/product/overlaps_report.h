#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/product/selection.h"
#include "base/work_watch.h"
#include "product/product.h"

/** What shares space as drawn, and what may give, in `hvas inspect` (section `overlaps`). */
namespace hvas::app {

/** Adds "drawing_errors", "overlaps", "flexible_parts" and "elastic_parts". Incomplete when the
 * watch ends it. */
void AddOverlaps(const product::Product& product, const Selection& selection, WorkWatch* watch,
                 nlohmann::ordered_json* json);

/** Prints them for people, as far as there are any. Incomplete when the watch ends it. */
void PrintOverlaps(const product::Product& product, const Selection& selection, bool is_all,
                   WorkWatch* watch);

}  // namespace hvas::app
