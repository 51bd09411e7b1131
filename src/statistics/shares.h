#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "statistics/summary.h"

namespace hvas::statistics {

/** Right answers among trials that do not depend on each other. */
struct Share {
  std::int64_t right{0};
  std::int64_t trials{0};
  double share{0};
  Interval ci;  ///< Clopper and Pearson, Biometrika 26, 1934: never too narrow.
  /** Probability of so many or more by chance alone, one-sided. None where no chance was named. */
  std::optional<double> chance_p;
};

/** Errors: kInvalid for counts out of range, chance or confidence not in (0, 1). */
[[nodiscard]] Result<Share> CalcShare(std::int64_t right, std::int64_t trials,
                                      std::optional<double> chance = {}, double confidence = 0.95);

/** What was shown and what was answered. */
struct Confusion {
  std::vector<std::vector<std::int64_t>> counts;  ///< [shown][answered].
  Share accuracy;  ///< Chance: by the shares of what was shown and answered.
  std::vector<std::optional<Share>> recall;  ///< One for each kind; none where it was not shown.
  /** Cohen, Educational and Psychological Measurement 20, 1960: agreement beyond chance. None where
   one answer and one thing shown are all there is. */
  std::optional<double> kappa;
};

/** @param chance Of a right answer by guessing. Errors: kInvalid for a matrix that is not square,
 negative counts, nothing counted, and as CalcShare. */
[[nodiscard]] Result<Confusion> CalcConfusion(std::vector<std::vector<std::int64_t>> counts,
                                              std::optional<double> chance = {},
                                              double confidence = 0.95);

}  // namespace hvas::statistics
