#pragma once

#include <string>
#include <vector>

#include "app/fit/fit_card.h"
#include "app/fit/fit_population.h"
#include "base/result.h"

namespace hvas::app {

/** Axial forces of one or several fits over the depth; pressing in and pulling out. */
struct FitCurve {
  struct Forces {
    double in{0};
    double out{0};
  };

  struct Point {
    double depth{0};           // Of the shaft [m].
    Forces least, mean, most;  // By the limits, without roughness [N].
    Forces pair;               // A tight pair of the batch, with its roughness [N].
    fits::ForceBand band;      // Of the batch, pressing in; pulling out by the ratio of friction.
  };

  std::vector<FitCard> cards;
  FitPopulationOptions options;
  fits::Population batch;
  std::vector<Point> points;
  std::vector<double> pair_clearances;  ///< One for each fit, by the pair's diameters [m].
  double release_ratio{1};              ///< Friction pulling out over friction pressing in.
  double work_most{0};                  ///< Work that presses in the largest interference [J].
};

/** @param step  Of the depth [m]; 0: a two hundredth of the way. Errors: kInvalid for a step that
 makes more than a million points, or no joint. */
[[nodiscard]] Result<FitCurve> MakeFitCurve(const std::vector<FitCard>& cards,
                                            const FitPopulationOptions& options, double step);

[[nodiscard]] std::string ToCsv(const FitCurve& curve);
[[nodiscard]] std::string ToSvg(const FitCurve& curve);

}  // namespace hvas::app
