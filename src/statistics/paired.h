#pragma once

#include <optional>
#include <span>

#include "statistics/summary.h"

namespace hvas::statistics {

/** Second minus first, pair by pair. */
struct PairedDifference {
  Summary summary;  ///< The differences'.
  double first_mean{0};
  double second_mean{0};
  /** The mean difference in per cent of the first mean, as paper X tells of times: 9.4 s is -25.4 %
   of 12.6 s. None where the first mean is not above zero. */
  std::optional<double> percent;
};

/** Errors: kInvalid for samples of different size, and as Summarise. */
[[nodiscard]] Result<PairedDifference> ComparePairs(std::span<const double> first,
                                                    std::span<const double> second,
                                                    double confidence = 0.95);

/** The mean difference in units of its standard deviation, Cohen's d_z. */
struct StandardizedDifference {
  double d_z{0};
  Interval ci;  ///< Follows from the non-central t distribution, by inversion.
};

/** None for fewer than two differences and where all are equal. Errors: as Summarise. */
[[nodiscard]] Result<std::optional<StandardizedDifference>> CalcStandardizedDifference(
    std::span<const double> differences, double confidence = 0.95);

}  // namespace hvas::statistics
