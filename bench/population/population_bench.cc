/** How long a batch of assemblies takes: a line of JSON for population_bench.py, which compares it
 with numpy. */
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "fits/population.h"

namespace {

using namespace hvas::fits;  // NOLINT: a program of its own.

double ProcessorTime() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  const std::int64_t count = argc > 1 ? std::atoll(argv[1]) : 1'000'000;
  const int passes = argc > 2 ? std::atoi(argv[2]) : 5;
  const FitLimits limits = *CalcFitLimits(*ParseFit("H7/k6"), 0.04);
  PopulationLand land{*SizeDistribution::FromCapability(limits.hole, 1, 1, true),
                      *SizeDistribution::FromCapability(limits.shaft, 1, 1, true),
                      0,
                      20,
                      {}};
  land.press.joint_diameter = 0.04;
  land.press.hub_diameter = 0.08;
  land.press.length = 0.05;
  land.press.hub_roughness = land.press.shaft_roughness = 6.3e-6;
  PopulationParameters parameters;
  parameters.lands = {land};
  parameters.count = count;
  double best = std::numeric_limits<double>::infinity();
  Population batch;
  for (int i = 0; i < passes; ++i) {
    const double start = ProcessorTime();
    batch = *CalcPopulation(parameters);
    best = std::min(best, ProcessorTime() - start);
  }
  const auto& end = batch.bands.back();
  fmt::print(
      "{{\"count\": {}, \"time_s\": {:.6f}, \"mean_n\": {:.3f}, \"q05_n\": {:.3f}, "
      "\"q95_n\": {:.3f}}}\n",
      count, best, end.mean, end.quantiles[1], end.quantiles[3]);
  return 0;
}
