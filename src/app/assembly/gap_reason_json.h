#pragma once

#include <nlohmann/json.hpp>

#include "orders/gap_reason.h"

namespace hvas::app {

/** Why a part cannot be brought in, and what would let it in, as commands print it. Every number's
 name ends in its unit; directions are unit vectors in W. */
[[nodiscard]] nlohmann::ordered_json MakeGapReasonJson(const simulation::Model& model,
                                                       const orders::GapReason& reason);

}  // namespace hvas::app
