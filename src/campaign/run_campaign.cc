#include "campaign/run_campaign.h"

#include <atomic>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "base/parallel.h"

namespace hvas::campaign {
namespace {

/** Shards of one call, calculated by several threads. */
class ShardCrew {
 public:
  ShardCrew(const CampaignFolder* folder, const RunCampaignOptions* options)
      : folder_(folder), options_(options), cells_(&folder->plan(), options->open) {}

  void Work(std::int64_t shard) {
    if (has_failed_ || options_->stop.stop_requested()) {
      return;
    }
    const ShardKey key = folder_->MakeKey(shard);
    const std::filesystem::path file = folder_->PathOf(shard);
    const auto there = ReadShard(file, key);
    if (there) {
      Count(shard, &report_.kept);
      return;
    }
    if (there.error().code != ErrorCode::kNotFound) {
      const std::lock_guard lock(mutex_);
      report_.damaged.push_back(there.error().ToString());
    }
    const auto rows = CalcShard(&cells_, shard, options_->stop);
    const auto written = rows ? WriteShard(file, key, *rows) : Unexpected(rows.error());
    if (!written) {
      const std::lock_guard lock(mutex_);
      has_failed_ = true;
      error_ = error_ ? error_ : written.error();
      return;
    }
    Count(shard, &report_.calculated);
  }

  [[nodiscard]] std::int64_t runs_done() const { return runs_done_; }

  Result<RunCampaignReport> Finish() {
    if (error_) {
      return Unexpected(*error_);
    }
    if (options_->stop.stop_requested()) {
      return Fail(ErrorCode::kCancelled, "the campaign was stopped", folder_->path().string(),
                  "run it again: the shards that are done stay");
    }
    return std::move(report_);
  }

 private:
  void Count(std::int64_t shard, std::int64_t* counter) {
    const RunRange runs = FindRuns(folder_->plan(), shard);
    const std::lock_guard lock(mutex_);
    ++*counter;
    runs_done_ += runs.end - runs.first;
  }

  const CampaignFolder* folder_;
  const RunCampaignOptions* options_;
  CellStore cells_;
  std::mutex mutex_;
  std::atomic<bool> has_failed_{false};
  std::atomic<std::int64_t> runs_done_{0};
  std::optional<Error> error_;
  RunCampaignReport report_;
};

}  // namespace

Result<std::vector<RunResult>> CalcShard(CellStore* cells, std::int64_t shard,
                                         const std::stop_token& stop) {
  const Plan& plan = cells->plan();
  const RunRange runs = FindRuns(plan, shard);
  std::vector<RunResult> rows;
  rows.reserve(static_cast<std::size_t>(runs.end - runs.first));
  std::shared_ptr<const PreparedCell> cell;
  for (std::int64_t run = runs.first; run < runs.end; ++run) {
    if (stop.stop_requested()) {
      return Fail(ErrorCode::kCancelled, "the shard was stopped", plan.file.string(),
                  "run it again");
    }
    const std::int64_t index = run / plan.seeds.count;
    if (!cell || cell->cell.index != index) {
      auto prepared = cells->Prepare(index);
      if (!prepared) {
        return Unexpected(prepared.error());
      }
      cell = *std::move(prepared);
    }
    const std::uint64_t seed =
        plan.seeds.first + static_cast<std::uint64_t>(run % plan.seeds.count);
    auto row = plan.method == Method::kFits
                   ? Result<RunResult>(CalcRun(*cell, plan, seed))
                   : PlayRun(*cell, plan, seed, {{}, false, cells->shapes(), stop});
    if (!row) {
      return Unexpected(row.error());
    }
    row->run = run;
    rows.push_back(*row);
  }
  return rows;
}

Result<RunCampaignReport> RunShards(const CampaignFolder& folder, const std::string& program,
                                    const std::vector<std::int64_t>& shards,
                                    const RunCampaignOptions& options) {
  if (const auto same = folder.CheckInputs(program); !same) {
    return Unexpected(same.error());
  }
  std::int64_t total = 0;
  for (const std::int64_t shard : shards) {
    const RunRange runs = FindRuns(folder.plan(), shard);
    total += runs.end - runs.first;
  }
  ShardCrew crew(&folder, &options);
  const auto progress = [&](std::size_t /*done*/) {
    if (options.progress) {
      options.progress(crew.runs_done(), total);
    }
  };
  ForEachIndex(
      shards.size(), options.jobs, [&](std::size_t i) { crew.Work(shards[i]); }, progress);
  return crew.Finish();
}

Result<RunCampaignReport> RunCampaign(const CampaignFolder& folder, const std::string& program,
                                      const RunCampaignOptions& options) {
  std::vector<std::int64_t> shards(static_cast<std::size_t>(folder.plan().CountShards()));
  std::iota(shards.begin(), shards.end(), 0);
  return RunShards(folder, program, shards, options);
}

}  // namespace hvas::campaign
