#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "assembly/open_product.h"
#include "base/result.h"
#include "campaign/campaign_folder.h"
#include "campaign/prepared_cell.h"
#include "campaign/run_result.h"
#include "statistics/shares.h"
#include "statistics/sobol.h"

namespace hvas::campaign {

/** Counts of forces in logarithmic steps, from which quantiles are found within half a per cent
 whatever the number of values. The order of the values does not matter. */
class ForceCounts {
 public:
  /** Counts a force [N]. Forces up to 1 mN are zero. */
  void Add(double force);

  /** The force that a share p in [0, 1] of the values does not exceed [N]; 0 where there is none.
   */
  [[nodiscard]] double Quantile(double p) const;

  [[nodiscard]] double max() const { return max_; }

 private:
  std::map<int, std::int64_t> counts_;  // By step; below all others are the zeros.
  std::int64_t zeros_{0};
  std::int64_t total_{0};
  double max_{0};
};

/** Shares of the runs at which the quantiles of a summary stand. */
inline constexpr std::array<double, 5> kForceShares{0.05, 0.5, 0.95, 0.99, 0.999};

/** What fails first, and how often. */
struct FailureCount {
  Cause cause{Cause::kNone};
  std::int64_t entity{-1};
  std::string name;  ///< Name of the mate or part; may be empty.
  std::int64_t count{0};
};

/** Runs with a factor in one of equal parts of its range. */
struct EffectBin {
  double deviation{0};  ///< Middle of the bin: deviation of a size from nominal [m]; else 0.
  std::int64_t runs{0};
  std::int64_t complete{0};
  double force_sum{0};  ///< [N]
};

/** Main effect of a factor: what comes of it while all others vary. */
struct MainEffect {
  std::string factor;
  std::vector<EffectBin> bins;
  double yield_range{0};  ///< Highest less lowest share of complete products of the bins.
  double force_range{0};  ///< Highest less lowest mean force [N].
  /** Share of the variance of the force between the bins (Pearson's correlation ratio), 0 to 1. */
  double force_ratio{0};
};

/** Sobol's indices of a factor. */
struct SobolOfFactor {
  std::string factor;
  std::optional<statistics::SobolIndex> complete;  ///< None where all, or none, are complete.
  std::optional<statistics::SobolIndex> force;     ///< None where the force does not vary.
};

/** Results of one combination of the plan. */
struct CellSummary {
  Cell cell;
  std::string name;
  std::int64_t runs{0};
  std::int64_t complete{0};
  std::optional<statistics::Share> yield;  ///< Share that is complete; none without runs.
  double force_mean{0};                    ///< [N]
  double force_max{0};                     ///< [N]
  std::array<double, kForceShares.size()> force_quantiles{};  ///< [N]
  double clearance_min{0};                                    ///< Least of all [m]
  double clearance_mean{0};                                   ///< [m]
  double time_mean{0};                                        ///< [s]; 0 with the method fits.
  std::vector<FailureCount> failures;                         ///< The most frequent first.
  // The following need the CAD files; they are empty where these are not there.
  std::optional<double> tolerance;  ///< Sum of the widths of all zones [m].
  std::optional<int> cost_rank;     ///< See CalcCostRank.
  bool is_best{false};  ///< No other combination has more yield at no higher cost, or the reverse.
  std::vector<MainEffect> effects;
  std::vector<SobolOfFactor> sobol;
};

/** A run that is close to its limits or beyond. */
struct WorstRun {
  RunResult result;
  std::string play;  ///< Words of a command that plays it.
};

struct Summary {
  std::string id;
  std::string digest;  ///< Digest of all rows that are there, in the order of their runs.
  std::int64_t shards{0};
  std::int64_t runs{0};
  std::int64_t runs_done{0};
  std::vector<std::int64_t> missing;                          ///< Shards without a file.
  std::vector<std::pair<std::int64_t, std::string>> damaged;  ///< Shards, and what is wrong.
  std::vector<CellSummary> cells;
  std::vector<WorstRun> worst;  ///< The largest utilisation first; parts not in place before.
  std::string notes;            ///< Why effects are missing; empty where they are not.

  [[nodiscard]] bool is_complete() const { return missing.empty() && damaged.empty(); }
};

/** Rank of cost of a product's fits: for each hole and shaft with a tolerance class 18 less its
 grade, summed. IT18 costs nothing, each finer grade one more. It is a rank and not money: it orders
 fits of one product, and nothing else. */
[[nodiscard]] int CalcCostRank(const product::Product& product);

struct CollectOptions {
  std::string program;          ///< This program, to compare with that of the folder.
  assembly::OpenOptions open;   ///< Options for opening the CAD files.
  std::filesystem::path table;  ///< A file for all rows, as SQLite; empty: none.
  std::size_t worst{10};        ///< Runs that are listed.
  std::function<void(double fraction)> progress;  ///< May be null.
  std::stop_token stop;
};

/** Merges the shards that are there, in the order of their runs, and names those that are missing
 or damaged. The digest is that of the rows alone: it does not depend on the size of shards, nor on
 who calculated them and when. Errors: kOutOfResource and those of the database for a table that
 cannot be written, which leaves none; kCancelled after a stop. */
[[nodiscard]] Result<Summary> Collect(const CampaignFolder& folder, const CollectOptions& options);

}  // namespace hvas::campaign
