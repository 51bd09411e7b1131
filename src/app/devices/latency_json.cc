#include "app/devices/latency_json.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/text_layout.h"

namespace hvas::app {

double ToUs(std::int64_t time_ns) {
  return 1e-3 * static_cast<double>(time_ns);
}

nlohmann::ordered_json MakeLatencyJson(const LatencyHistogram& histogram) {
  return {{"median", ToUs(histogram.Quantile(0.5))},
          {"p99", ToUs(histogram.Quantile(0.99))},
          {"p999", ToUs(histogram.Quantile(0.999))},
          {"max", ToUs(histogram.max_ns())}};
}

void PrintLatencyHistogram(const std::string& title, const LatencyHistogram& histogram) {
  fmt::print("{}",
             Fold(fmt::format("{}: median {:.1f}, p99 {:.1f}, p99.9 {:.1f}, max {:.1f} us\n", title,
                              ToUs(histogram.Quantile(0.5)), ToUs(histogram.Quantile(0.99)),
                              ToUs(histogram.Quantile(0.999)), ToUs(histogram.max_ns()))));
  std::uint64_t below = 0;
  for (std::int64_t end_us = 1; below < histogram.count(); end_us *= 2) {
    const std::uint64_t up_to = histogram.CountUpTo(1000 * end_us);
    if (up_to > below) {
      constexpr double kWidth = 45;  // Columns of the longest bar, beside the numbers in 80.
      const double share =
          static_cast<double>(up_to - below) / static_cast<double>(histogram.count());
      fmt::print("  up to {:>8} us {:>9} {}\n", end_us, up_to - below,
                 std::string(static_cast<std::size_t>(std::ceil(kWidth * share)), '#'));
    }
    below = up_to;
  }
}

}  // namespace hvas::app
