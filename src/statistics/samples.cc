#include "statistics/samples.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace hvas::statistics {

Result<void> CheckSample(std::span<const double> values) {
  if (values.empty()) {
    return Fail(ErrorCode::kInvalid, "there are no values", "sample", "give at least one");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      return Fail(ErrorCode::kInvalid, fmt::format("value {} is not finite", i + 1), "sample",
                  "omit values that were not measured");
    }
  }
  return {};
}

double FindTieTolerance(std::span<const double> values) {
  constexpr double kRounding = 1e-13;  // Some hundred units in the last place.
  double largest = 0;
  for (const double value : values) {
    largest = std::max(largest, std::abs(value));
  }
  return kRounding * largest;
}

Result<std::vector<double>> CalcDifferences(std::span<const double> first,
                                            std::span<const double> second) {
  if (first.size() != second.size()) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} values against {}", first.size(), second.size()), "paired samples",
                "give a pair of each participant");
  }
  for (const std::span<const double> sample : {first, second}) {
    if (const auto checked = CheckSample(sample); !checked) {
      return Unexpected(checked.error());
    }
  }
  const double tolerance = std::max(FindTieTolerance(first), FindTieTolerance(second));
  std::vector<double> differences(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double difference = second[i] - first[i];
    differences[i] = std::abs(difference) <= tolerance ? 0 : difference;
  }
  return differences;
}

}  // namespace hvas::statistics
