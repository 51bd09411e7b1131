#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "base/result.h"

/** Statistics as docs/algorithms/statistics.md has them: pure functions of numbers, in the unit of
 what goes in. Nothing here gives NaN: what the data do not define is none or an error. */
namespace hvas::statistics {

/** A range of values, both ends included. */
struct Interval {
  double low{0};
  double high{0};
};

/** Levels and shares of confidence are open intervals. Errors: kInvalid. */
[[nodiscard]] Result<void> CheckConfidence(double confidence);

/** A sample in figures. */
struct Summary {
  std::size_t n{0};
  double mean{0};
  std::optional<double> sd;         ///< Divides by n - 1; none for n = 1.
  std::optional<Interval> mean_ci;  ///< Follows from Student's t; none for n = 1.
  double min{0};
  double lower_quartile{0};  ///< Quartiles of type 7 of Hyndman and Fan.
  double median{0};
  double upper_quartile{0};
  double max{0};
};

/** Errors: kInvalid for no values, values that are not finite, or a confidence not in (0, 1). */
[[nodiscard]] Result<Summary> Summarise(std::span<const double> values, double confidence = 0.95);

/** The quantile of a sorted sample, linear between order statistics: type 7 of Hyndman and Fan,
 The American Statistician 50(4), 1996, which is what R and spreadsheets give.
 @pre not empty, ascending; 0 <= p <= 1. */
[[nodiscard]] double CalcQuantile(std::span<const double> sorted, double p);

}  // namespace hvas::statistics
