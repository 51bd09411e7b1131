#include "campaign/summary.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <system_error>

#include <fmt/format.h>

#include "base/digest.h"
#include "base/parallel.h"
#include "campaign/effects.h"
#include "campaign/row_table.h"
#include "campaign/table_file.h"
#include "fits/iso286.h"

namespace hvas::campaign {
namespace {

constexpr double kLeastForce = 1e-3;  // [N]: what a scale does not show.
constexpr double kStepRatio = 1.005;  // Of the ends of a step: half a per cent.
constexpr int kCoarsestGrade = 18;    // of ISO 286

/** What is counted while the rows of a combination go by. */
struct CellCounts {
  std::int64_t runs{0};
  std::int64_t complete{0};
  double force_sum{0};
  double clearance_sum{0};
  double clearance_min{0};
  double time_sum{0};
  ForceCounts forces;
  std::map<std::pair<Cause, std::int64_t>, std::int64_t> failures;
  std::shared_ptr<const PreparedCell> prepared;  ///< Null where the CAD file is not there.
  std::optional<EffectCounts> effects;
};

void Count(const RunResult& row, CellCounts* counts) {
  counts->clearance_min =
      counts->runs == 0 ? row.clearance : std::min(counts->clearance_min, row.clearance);
  ++counts->runs;
  counts->complete += row.is_complete ? 1 : 0;
  counts->force_sum += row.force;
  counts->clearance_sum += row.clearance;
  counts->time_sum += row.time;
  counts->forces.Add(row.force);
  if (row.cause != Cause::kNone) {
    ++counts->failures[{row.cause, row.entity}];
  }
  if (counts->effects) {
    counts->effects->Add(row);
  }
}

/** Whether one run is worse than another; of equal ones the earlier is. */
bool IsWorse(const RunResult& a, const RunResult& b) {
  const auto rank = [](const RunResult& r) {
    return std::pair(r.cause == Cause::kNotSeated ? 1 : 0, r.utilisation);
  };
  return rank(a) != rank(b) ? rank(a) > rank(b) : a.run < b.run;
}

std::string NameEntity(const CellCounts& counts, Cause cause, std::int64_t entity) {
  if (entity < 0) {
    return {};
  }
  if (!counts.prepared) {
    return fmt::format("{}{}", cause == Cause::kNotSeated ? "o" : "m", entity);
  }
  const auto& occurrences = counts.prepared->product.occurrences;
  const auto index = static_cast<std::size_t>(entity);
  if (cause == Cause::kNotSeated) {
    return index < occurrences.size() ? occurrences[index].path : fmt::format("o{}", entity);
  }
  const auto& mates = counts.prepared->fits.mates();
  const auto found = std::find_if(mates.begin(), mates.end(), [entity](const FittedMate& mate) {
    return mate.id.value() == entity;
  });
  return found == mates.end() ? fmt::format("m{}", entity) : found->name;
}

/** Sum of the widths of the zones of all fits [m]. */
double CalcTolerance(const FitModel& fits) {
  double sum = 0;
  for (const FittedMate& mate : fits.mates()) {
    for (const fits::SideToDraw* side : {&mate.fit.pair.hole, &mate.fit.pair.shaft}) {
      sum += side->zone ? side->zone->upper - side->zone->lower : 0;
    }
  }
  return sum;
}

Result<CellSummary> Summarise(const Plan& plan, std::int64_t index, const CellCounts& counts) {
  CellSummary summary;
  summary.cell = FindCell(plan, index);
  summary.name = DescribeCell(plan, summary.cell);
  summary.runs = counts.runs;
  summary.complete = counts.complete;
  const auto share = statistics::CalcShare(counts.complete, counts.runs);
  if (!share) {
    return Unexpected(share.error());
  }
  summary.yield = *share;
  const auto n = static_cast<double>(counts.runs);
  summary.force_mean = counts.force_sum / n;
  summary.force_max = counts.forces.max();
  for (std::size_t i = 0; i < kForceShares.size(); ++i) {
    summary.force_quantiles[i] = counts.forces.Quantile(kForceShares[i]);
  }
  summary.clearance_min = counts.clearance_min;
  summary.clearance_mean = counts.clearance_sum / n;
  summary.time_mean = counts.time_sum / n;
  for (const auto& [what, count] : counts.failures) {
    summary.failures.push_back(
        {what.first, what.second, NameEntity(counts, what.first, what.second), count});
  }
  std::stable_sort(summary.failures.begin(), summary.failures.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  if (counts.prepared) {
    summary.tolerance = CalcTolerance(counts.prepared->fits);
    summary.cost_rank = CalcCostRank(counts.prepared->product);
  }
  if (counts.effects) {
    summary.effects = counts.effects->CalcEffects();
  }
  return summary;
}

/** Marks the combinations of each product that no other one dominates. */
void MarkBest(std::vector<CellSummary>* cells) {
  for (CellSummary& one : *cells) {
    one.is_best = one.cost_rank.has_value();
    for (const CellSummary& other : *cells) {
      if (!one.cost_rank || !other.cost_rank || other.cell.product != one.cell.product) {
        continue;
      }
      const double more = other.yield->share - one.yield->share;
      const int less = *one.cost_rank - *other.cost_rank;
      one.is_best = one.is_best && !((more > 0 && less >= 0) || (more >= 0 && less > 0));
    }
  }
}

/** Reads the shards of a campaign one after the other. */
class Collector {
 public:
  Collector(const CampaignFolder* folder, const CollectOptions* options)
      : folder_(folder), options_(options), cells_(&folder->plan(), options->open) {
    const auto same = folder->CheckInputs(options->program);
    if (!same) {
      summary_.notes =
          "tolerances, costs and effects are missing, as they need the CAD files and "
          "the program of the campaign: " +
          same.error().ToString();
    }
    has_products_ = same.has_value();
  }

  Result<Summary> Run() {
    const Plan& plan = folder_->plan();
    summary_.id = plan.id;
    summary_.shards = plan.CountShards();
    summary_.runs = plan.CountRuns();
    if (!options_->table.empty()) {
      auto table = TableFile::Create(options_->table);
      if (!table) {
        return Unexpected(table.error());
      }
      table_.emplace(*std::move(table));
    }
    if (const auto added = AddAll(); !added) {
      return Unexpected(added.error());
    }
    return Finish();
  }

 private:
  using Rows = Result<std::vector<RunResult>>;

  /** Adds all shards in their order. While some are added, the next ones are read by other threads.
   */
  Result<void> AddAll() {
    constexpr std::int64_t kBatch = 8;  // Shards in memory at a time, a few MB: a choice.
    std::vector<Rows> batch;
    for (std::int64_t first = -kBatch; first < summary_.shards; first += kBatch) {
      if (options_->stop.stop_requested()) {
        return Fail(ErrorCode::kCancelled, "collecting was stopped", folder_->path().string(),
                    "collect again: the shards stay as they are");
      }
      if (options_->progress) {
        options_->progress(static_cast<double>(std::max<std::int64_t>(0, first)) /
                           static_cast<double>(summary_.shards));
      }
      const std::int64_t next = first + kBatch;
      const auto count =
          static_cast<std::size_t>(std::clamp<std::int64_t>(summary_.shards - next, 0, kBatch));
      std::vector<Rows> read(count);
      Result<void> added;
      ForEachIndex(count + 1, 0, [&](std::size_t i) {
        if (i == 0) {
          added = AddBatch(first, batch);
        } else {
          const std::int64_t shard = next + static_cast<std::int64_t>(i) - 1;
          read[i - 1] = ReadShard(folder_->PathOf(shard), folder_->MakeKey(shard));
        }
      });
      if (!added) {
        return added;
      }
      batch = std::move(read);
    }
    return {};
  }

  Result<void> AddBatch(std::int64_t first, const std::vector<Rows>& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (auto added = AddShard(first + static_cast<std::int64_t>(i), batch[i]); !added) {
        return added;
      }
    }
    return {};
  }

  Result<void> AddShard(std::int64_t shard, const Rows& rows) {
    if (!rows && rows.error().code == ErrorCode::kNotFound) {
      summary_.missing.push_back(shard);
      return {};
    }
    if (!rows) {
      summary_.damaged.emplace_back(shard, rows.error().ToString());
      return {};
    }
    for (const RunResult& row : *rows) {
      if (auto added = AddOne(row); !added) {
        return added;
      }
    }
    return {};
  }

  Result<void> AddOne(const RunResult& row) {
    const Plan& plan = folder_->plan();
    if (row.cell < 0 || row.cell >= plan.CountCells() || row.run < 0 ||
        row.run >= plan.CountRuns()) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("a shard has run {} of combination {}, which the plan does not have",
                              row.run, row.cell),
                  folder_->path().string(), "remove its shards, and run the campaign again");
    }
    AddRow(row, &digest_);
    ++summary_.runs_done;
    auto found = counts_.find(row.cell);
    if (found == counts_.end()) {
      found = counts_.emplace(row.cell, CellCounts()).first;
      if (auto prepared = PrepareCounts(row.cell, &found->second); !prepared) {
        return prepared;
      }
    }
    Count(row, &found->second);
    Keep(row);
    return table_ ? table_->Add(row) : Result<void>();
  }

  Result<void> PrepareCounts(std::int64_t cell, CellCounts* counts) {
    if (!has_products_) {
      return {};
    }
    auto prepared = cells_.Prepare(cell);
    if (!prepared) {
      return Unexpected(prepared.error());
    }
    counts->prepared = *std::move(prepared);
    counts->effects.emplace(counts->prepared);
    return {};
  }

  /** Keeps the worst runs. */
  void Keep(const RunResult& row) {
    const bool is_full = worst_.size() == options_->worst;
    if (options_->worst == 0 || (is_full && !IsWorse(row, worst_.back()))) {
      return;
    }
    worst_.insert(std::upper_bound(worst_.begin(), worst_.end(), row, IsWorse), row);
    if (worst_.size() > options_->worst) {
      worst_.pop_back();
    }
  }

  Result<Summary> Finish() {
    const Plan& plan = folder_->plan();
    for (const auto& [index, counts] : counts_) {
      auto cell = Summarise(plan, index, counts);
      if (!cell) {
        return Unexpected(cell.error());
      }
      if (plan.sensitivity && counts.prepared) {
        auto sobol = CalcSobolOfFactors(*counts.prepared, plan, options_->stop);
        if (!sobol) {
          return Unexpected(sobol.error());
        }
        cell->sobol = *std::move(sobol);
      }
      summary_.cells.push_back(*std::move(cell));
    }
    MarkBest(&summary_.cells);
    for (const RunResult& row : worst_) {
      summary_.worst.push_back({row, DescribePlay(plan, row)});
    }
    summary_.digest = digest_.Hex();
    if (table_) {
      if (const auto finished = table_->Finish(); !finished) {
        return Unexpected(finished.error());
      }
    }
    return std::move(summary_);
  }

  const CampaignFolder* folder_;
  const CollectOptions* options_;
  CellStore cells_;
  bool has_products_{false};
  Summary summary_;
  Digest digest_;
  std::map<std::int64_t, CellCounts> counts_;
  std::vector<RunResult> worst_;  // The worst first.
  std::optional<TableFile> table_;
};

}  // namespace

void ForceCounts::Add(double force) {
  ++total_;
  max_ = std::max(max_, force);
  if (force <= kLeastForce) {
    ++zeros_;
    return;
  }
  const double bounded = std::min(force, 1e12);  // An infinite force has a step, too.
  ++counts_[static_cast<int>(std::log(bounded / kLeastForce) / std::log(kStepRatio))];
}

double ForceCounts::Quantile(double p) const {
  const auto rank = static_cast<std::int64_t>(std::ceil(p * static_cast<double>(total_)));
  std::int64_t seen = zeros_;
  if (seen >= std::max<std::int64_t>(rank, 1)) {
    return 0;
  }
  for (const auto& [step, count] : counts_) {
    seen += count;
    if (seen >= rank) {
      return std::min(max_, kLeastForce * std::pow(kStepRatio, step + 0.5));
    }
  }
  return max_;
}

int CalcCostRank(const product::Product& product) {
  int rank = 0;
  for (const product::Mate& mate : product.mates) {
    if (!mate.fit || mate.fit->code.empty()) {
      continue;
    }
    if (const auto fit = fits::ParseFit(mate.fit->code)) {
      rank += 2 * kCoarsestGrade - fit->hole.grade - fit->shaft.grade;
    } else if (const auto side = fits::ParseToleranceClass(mate.fit->code)) {
      rank += kCoarsestGrade - side->grade;
    }
  }
  return rank;
}

Result<Summary> Collect(const CampaignFolder& folder, const CollectOptions& options) {
  return Collector(&folder, &options).Run();
}

}  // namespace hvas::campaign
