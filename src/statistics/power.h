#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "base/result.h"
#include "statistics/shares.h"

/** How many participants a study within participants needs, by simulation of the whole study. */
namespace hvas::statistics {

/** Values of a normal distribution, which one participant has in common to the share `correlation`:
 mean + sd (sqrt(correlation) U + sqrt(1 - correlation) E). */
struct NormalDesign {
  std::vector<double> means;
  std::vector<double> sds;  ///< One each, above zero.
  double correlation{0.5};  ///< Correlation between two conditions of one participant, [0, 1).
};

/** Times as they are as a rule, skew: the same of the logarithm. */
struct LogNormalDesign {
  std::vector<double> medians;  ///< Above zero.
  std::vector<double> log_sds;  ///< Spread of the natural logarithm: 0.3 is about 30 %.
  double correlation{0.5};
};

/** Counts of right answers; all participants are as good. */
struct CountDesign {
  std::vector<double> shares;  ///< Probability of a right answer, [0, 1].
  int of{15};                  ///< Trials of each.
};

/** Rows of a pilot study, drawn with putting back. */
struct PilotDesign {
  std::vector<std::vector<double>> rows;  ///< One value a condition each.
};

using Design = std::variant<NormalDesign, LogNormalDesign, CountDesign, PilotDesign>;

enum class PowerTest {
  kFriedman,  ///< Friedman's test by chi-square.
  kWilcoxon,  ///< Wilcoxon's test by the normal approximation; two conditions.
};

struct PowerOptions {
  PowerTest test{PowerTest::kFriedman};
  double alpha{0.05};     ///< Level of this one test, in (0, 0.5).
  double target{0.8};     ///< Power that is wanted, in (0, 1).
  int runs{10'000};       ///< Simulated studies for each number of participants, 100 to 1,000,000.
  std::uint64_t seed{1};  ///< Any number: the simulated studies follow from it.
  int most{500};          ///< Participants that are tried, 3 to 10,000.
};

struct PowerPoint {
  int participants{0};
  Share power;                  ///< Share of studies that found a difference, with its interval.
  double monte_carlo_error{0};  ///< Standard error of that share.
};

struct PowerResult {
  std::optional<int> participants;  ///< Least that reach the target; none up to the most.
  std::vector<PowerPoint> points;   ///< All that were tried, ascending.
};

/** Told with the participants that are being tried and the share of runs that are done. */
using PowerProgress = std::function<void(int participants, double fraction)>;

/** Errors: kInvalid for a design or options out of range. */
[[nodiscard]] Result<PowerPoint> EstimatePower(const Design& design, const PowerOptions& options,
                                               int participants,
                                               const PowerProgress& progress = {});

/** Doubles the participants until the target is reached, then halves the interval. The same
 simulated people take part in studies of every size, so that power hardly falls as they grow.
 Errors: as EstimatePower. */
[[nodiscard]] Result<PowerResult> FindSampleSize(const Design& design, const PowerOptions& options,
                                                 const PowerProgress& progress = {});

/** Conditions of a design. */
[[nodiscard]] std::size_t CountConditions(const Design& design);

}  // namespace hvas::statistics
