#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "orders/gap_reason.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** How many parts that have no way in are looked into, unless another number is given: a choice. */
inline constexpr std::size_t kMostReasons = 10;

struct ExplainGapsOptions {
  std::size_t most{kMostReasons};  ///< How many parts are looked into.
  std::optional<std::chrono::duration<double>>
      time;                                       ///< How long all looks may take; none: no limit.
  std::function<void(double fraction)> progress;  ///< May be null.
  std::stop_token stop;
};

/** Explains why parts of a model have no way in: those of Sequence::gaps, in their order, as many
 as the limits allow. Where the time ended a look, its reason says so (GapReason::is_limit_reached).
 The same model without a limit of time has the same reasons. */
[[nodiscard]] std::vector<orders::GapReason> ExplainGaps(const simulation::Model& model,
                                                         const ExplainGapsOptions& options);

}  // namespace hvas::assembly
