#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/result.h"
#include "fits/press_fit.h"
#include "fits/size_distribution.h"

namespace hvas::fits {

/** One fit of a pair of parts: a land along the axis. */
struct PopulationLand {
  SizeDistribution hole;   ///< Deviations of the hole's diameter.
  SizeDistribution shaft;  ///< Deviations of the shaft's.
  double start{0};         ///< Depth at which it begins to engage [m], >= 0.
  int stations{20};        ///< N, the intervals of B along it, 1 to 256.
  /** Geometry (length: the land's), materials, roughness (the mean of both is B's Rz) and friction.
   The interference comes from the sizes. */
  PressFitParameters press;
};

struct PopulationParameters {
  std::vector<PopulationLand> lands;  ///< One or more; they go in together.
  std::int64_t count{1'000'000};      ///< Number of assemblies, > 0.
  std::uint64_t seed{0};
  int threads{1};
  double press_force{std::numeric_limits<double>::infinity()};  ///< What the press can do [N].
  int depths{20};  ///< Steps of the common depth from 0 to the end of the last land, 1 to 256.
};

/** Shares of a batch below which a quantity lies. */
inline constexpr std::array<double, 5> kBandShares{0.001, 0.05, 0.5, 0.95, 0.999};

/** Force over depth of a batch. */
struct ForceBand {
  double depth{0};                                     ///< [m]
  double mean{0};                                      ///< [N]
  std::array<double, kBandShares.size()> quantiles{};  ///< [N], by kBandShares.
};

/** What a land of the batch is like. Clearances are diametral, of the mean sizes; negative is
 interference. */
struct LandStatistics {
  double mean_clearance{0};  ///< [m]
  double sigma_clearance{0};
  std::array<double, kBandShares.size()> clearance_quantiles{};
  std::vector<double> clearance_curve;  ///< Values at the shares 0, 1/200, .. 1; the ends by 1/400.
  double interference_share{0};         ///< Share of assemblies with interference.
  double yield_share{0};  ///< Whose pressure exceeds the least elastic limit (von Mises).
};

struct Population {
  std::int64_t count{0};
  std::vector<LandStatistics> lands;
  std::vector<ForceBand> bands;      ///< Bands from depth 0 to the end.
  double any_interference_share{0};  ///< Share of assemblies with interference in any land.
  double over_press_share{0};        ///< Whose force exceeds the press somewhere.
  double any_yield_share{0};
};

/** Draws a batch and assembles it (N4, W1 to W4, W8, W9): for each pair sizes and B(l_j), then
 F(l) = mu pi D_F integral_0^l p dl' with p of Lame's rings for U = -2 S(l'), smoothed.

 Blocks of assemblies draw from streams of their own, so that the same seed gives the same figures
 whatever the number of threads. Quantiles come from 2048 equal steps between the extremes that the
 sizes allow. Errors: kInvalid for parameters out of their range. */
[[nodiscard]] Result<Population> CalcPopulation(const PopulationParameters& parameters);

}  // namespace hvas::fits
