#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "base/result.h"
#include "campaign/prepared_cell.h"
#include "campaign/summary.h"

namespace hvas::campaign {

/** Counts of the runs of a combination by the values of each factor, which follow from the seed. */
class EffectCounts {
 public:
  /** @pre cell != nullptr. */
  explicit EffectCounts(std::shared_ptr<const PreparedCell> cell);

  void Add(const RunResult& row);

  /** Calculates the main effects of all factors but the surfaces, whose values have no order; the
   largest range of yield first, then that of force. */
  [[nodiscard]] std::vector<MainEffect> CalcEffects() const;

 private:
  std::shared_ptr<const PreparedCell> cell_;
  std::vector<std::vector<EffectBin>> bins_;  // By factor.
  std::vector<std::uint64_t> values_;         // Of one run.
  std::int64_t runs_{0};
  double force_sum_{0};
  double square_sum_{0};
};

/** Calculates Sobol's indices of all factors for the share that is complete and for the force, from
 Saltelli's design with the plan's number of rows, drawn by its first seed. Errors: those of
 statistics::CalcSobol; kCancelled after a stop. @pre plan.sensitivity. */
[[nodiscard]] Result<std::vector<SobolOfFactor>> CalcSobolOfFactors(const PreparedCell& cell,
                                                                    const Plan& plan,
                                                                    const std::stop_token& stop);

}  // namespace hvas::campaign
