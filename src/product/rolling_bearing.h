#pragma once

#include <vector>

#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::product {

/** Finds rolling bearings that are drawn in pieces: three or more equal balls or rollers evenly
 around one axis, between an inner and an outer ring on that axis (or two washers beside them), with
 all that lies between the rings (cage, shields, seals). Ids of each are ascending; none is in two.
 Incomplete when the watch ends it.
 @param may_take  Whether an occurrence may be part of one, by OccurrenceId. */
[[nodiscard]] std::vector<std::vector<OccurrenceId>> FindRollingBearings(
    const Product& product, const std::vector<bool>& may_take, WorkWatch* watch = nullptr);

}  // namespace hvas::product
