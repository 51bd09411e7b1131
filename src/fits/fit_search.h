#pragma once

#include <vector>

#include "base/result.h"
#include "fits/iso286.h"

namespace hvas::fits {

/** A fit that a search found. */
struct FoundFit {
  FitClass fit;
  FitLimits limits;
  bool is_common{false};  ///< Both classes are in common use.
  double unused{0};       ///< What the fit's clearances leave free of the range asked for [m].
};

/** Which basis the fits are taken from. */
enum class FitBasis { kHole, kShaft };

/** All fits of a basis (H with a to zc, or h with A to ZC; holes IT6 to IT11, shafts IT5 to IT11,
 at most two grades apart) whose clearances all lie between two [m], diametral, negative for
 interference. Common ones first, then those that leave the least of the range unused: the widest
 and so the cheapest tolerances.
 Errors: kInvalid for an empty range or a size outside the standard. */
[[nodiscard]] Result<std::vector<FoundFit>> FindFits(double nominal, double min_clearance,
                                                     double max_clearance, FitBasis basis);

}  // namespace hvas::fits
