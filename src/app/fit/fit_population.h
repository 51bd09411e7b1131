#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/fit/fit_card.h"
#include "base/result.h"
#include "fits/fit_force.h"
#include "fits/population.h"

namespace hvas::app {

/** How the sizes of a batch spread. */
enum class SizeSpread : std::uint8_t {
  kPaper,       ///< Paper W: whole micrometres, normal, sigma a sixth of the zone, cut off.
  kCapability,  ///< Normal, by C_p and C_pk.
  kUniform,
  kMeasured,  ///< Measured sizes, from a table.
};

struct FitPopulationOptions {
  std::int64_t count{100'000};  ///< A share of 1 % has a deviation of 0.03 %.
  std::uint64_t seed{0};
  int threads{0};         ///< 0: as many as the machine has. The figures are the same.
  double press_force{0};  ///< [N]; 0: any.
  int stations{20};       ///< N, the intervals of B.
  int depths{20};         ///< Steps of the depth.
  SizeSpread spread{SizeSpread::kPaper};
  double cp{1};                       ///< The tolerance is six deviations wide (ISO 22514-2).
  double cpk{1};                      ///< Sizes lie in the middle of the tolerance.
  std::vector<double> holes, shafts;  ///< Measured diameters [m], of the one fit.
  /** Diameters of one pair, measured along its length; empty: no such pair. */
  std::vector<fits::DiameterAtDepth> hole_along, shaft_along;
};

/** Reads the diameters of one pair along its length: a table with the columns depth_mm, hole_mm and
 shaft_mm, by ascending depth; cells of a side that is not measured there are empty.
 Errors: kNotFound, kInvalid with the row. */
[[nodiscard]] Result<void> ReadDiametersAlong(const std::string& file,
                                              FitPopulationOptions* options);

/** The measured diameters of a table with the columns hole_mm and shaft_mm; of either at least one.
 Errors: kNotFound, kInvalid with the row. */
[[nodiscard]] Result<void> ReadSizes(const std::string& file, FitPopulationOptions* options);

/** The pair without smoothing: where the roughness is drawn along the joint as B(l), it is not
 taken off the interference a second time (DIN 7190's G is for joints that are taken as even). */
[[nodiscard]] fits::PressFitParameters WithDrawnRoughness(fits::PressFitParameters press);

/** Puts pairs of parts together, each with all the fits at once. Errors: kInvalid where a card has
 no joint, or measured sizes go with several fits; those of populations. */
[[nodiscard]] Result<fits::Population> DrawPopulation(const std::vector<FitCard>& cards,
                                                      const FitPopulationOptions& options);

/** "C_p 1.33, C_pk 1", ... */
[[nodiscard]] std::string SpreadText(const FitPopulationOptions& options);

/** The shares of interference, of what the press cannot do, and of what yields. */
[[nodiscard]] std::string SharesText(const fits::Population& batch,
                                     const FitPopulationOptions& options);

[[nodiscard]] std::string ToText(const fits::Population& batch, const std::vector<FitCard>& cards,
                                 const FitPopulationOptions& options);
[[nodiscard]] nlohmann::ordered_json ToJson(const fits::Population& batch,
                                            const std::vector<FitCard>& cards,
                                            const FitPopulationOptions& options);

}  // namespace hvas::app
