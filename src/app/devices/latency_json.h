#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/histogram.h"

namespace hvas::app {

/** Converts nanoseconds to microseconds. */
[[nodiscard]] double ToUs(std::int64_t time_ns);

/** Quantiles of a histogram [us]: count, median, p99, p999, max. */
[[nodiscard]] nlohmann::ordered_json MakeLatencyJson(const LatencyHistogram& histogram);

/** A histogram as lines of text, a bar for each factor of two. */
void PrintLatencyHistogram(const std::string& title, const LatencyHistogram& histogram);

}  // namespace hvas::app
