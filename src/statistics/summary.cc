#include "statistics/summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/check.h"
#include "statistics/distributions.h"
#include "statistics/samples.h"

namespace hvas::statistics {

Result<void> CheckConfidence(double confidence) {
  if (confidence > 0 && confidence < 1) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, fmt::format("{} is not a confidence level", confidence),
              "confidence", "give a number between 0 and 1, such as 0.95");
}

Result<Summary> Summarise(std::span<const double> values, double confidence) {
  if (const auto checked = CheckConfidence(confidence); !checked) {
    return Unexpected(checked.error());
  }
  if (const auto checked = CheckSample(values); !checked) {
    return Unexpected(checked.error());
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  Summary summary;
  summary.n = sorted.size();
  const auto n = static_cast<double>(summary.n);
  for (const double value : sorted) {
    summary.mean += value / n;
  }
  if (summary.n > 1) {
    double squares = 0;
    for (const double value : sorted) {
      squares += (value - summary.mean) * (value - summary.mean);
    }
    // Equal values leave but rounding of the mean.
    summary.sd = sorted.front() == sorted.back() ? 0 : std::sqrt(squares / (n - 1));
    const double half =
        CalcStudentQuantile(0.5 + 0.5 * confidence, n - 1) * *summary.sd / std::sqrt(n);
    summary.mean_ci = Interval{summary.mean - half, summary.mean + half};
  }
  summary.min = sorted.front();
  summary.lower_quartile = CalcQuantile(sorted, 0.25);
  summary.median = CalcQuantile(sorted, 0.5);
  summary.upper_quartile = CalcQuantile(sorted, 0.75);
  summary.max = sorted.back();
  return summary;
}

double CalcQuantile(std::span<const double> sorted, double p) {
  HVAS_DEMAND(!sorted.empty() && 0 <= p && p <= 1);
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace hvas::statistics
