#pragma once

#include <cstdint>
#include <vector>

#include "product/product.h"

namespace hvas::product {

/** Whether two poses differ by rounding only: within 1 nm, and 1e-9 of the rotation. */
[[nodiscard]] bool IsSamePose(const Pose& X, const Pose& Y);

/** The micrometre that a coordinate lies in, for tables of poses. */
[[nodiscard]] std::int64_t PlaceCell(double value);

/** Finds for each occurrence the earlier one, if any, that has the same shape at the same place:
 files hold copies that somebody pasted and forgot. An original is never a copy itself. Takes time
 with the number of occurrences, however many lie at one place. */
[[nodiscard]] std::vector<OccurrenceId> FindOriginals(const Product& product);

}  // namespace hvas::product
