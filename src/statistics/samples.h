#pragma once

#include <span>
#include <vector>

#include "base/result.h"

namespace hvas::statistics {

/** Errors: kInvalid for no values and values that are not finite, by their number from 1. */
[[nodiscard]] Result<void> CheckSample(std::span<const double> values);

/** Second minus first, where differences that are but rounding are zero (FindTieTolerance).
 Errors: kInvalid for samples of different size, and as CheckSample. */
[[nodiscard]] Result<std::vector<double>> CalcDifferences(std::span<const double> first,
                                                          std::span<const double> second);

/** Values of this size that differ by no more are equal but for rounding: 12.3 - 12.1 and
 10.3 - 10.1. */
[[nodiscard]] double FindTieTolerance(std::span<const double> values);

}  // namespace hvas::statistics
