#pragma once

#include <ctime>
#include <vector>

namespace hvas::bench {

/** Processor time of the calling thread [s]: not what other programs take. */
[[nodiscard]] inline double ThreadSeconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Spread {
  double median{0}, p99{0}, max{0};
};

/** @pre values not empty. */
[[nodiscard]] Spread CalcSpread(std::vector<double> values);

}  // namespace hvas::bench
