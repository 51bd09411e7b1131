#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "assembly/open_product.h"
#include "base/result.h"
#include "campaign/campaign_folder.h"
#include "campaign/prepared_cell.h"

namespace hvas::campaign {

/** Calculates the rows of a shard, in the order of their runs. The same plan and files give the
 same rows. Errors: those of CellStore::Prepare and PlayRun; kCancelled after a stop. */
[[nodiscard]] Result<std::vector<RunResult>> CalcShard(CellStore* cells, std::int64_t shard,
                                                       const std::stop_token& stop = {});

struct RunCampaignOptions {
  unsigned jobs{0};            ///< Shards calculated at a time; 0: one for each core.
  assembly::OpenOptions open;  ///< Options for opening; file and fits are the plan's.
  std::function<void(std::int64_t done, std::int64_t total)>
      progress;  ///< Counts runs; may be null.
  std::stop_token stop;
};

/** What a call of RunShards has done. */
struct RunCampaignReport {
  std::int64_t kept{0};              ///< Shards that were there.
  std::int64_t calculated{0};        ///< Shards that were written.
  std::vector<std::string> damaged;  ///< Errors of files that were there and are replaced.
};

/** Calculates the shards of a campaign that are not there, or are damaged, and writes each. Shards
 that are there are read and checked. A shard that fails ends the rest; those that are written stay.
 Errors: those of CampaignFolder::CheckInputs, CalcShard and WriteShard; kCancelled after a stop.
 @param program  Version and build of the program. */
[[nodiscard]] Result<RunCampaignReport> RunShards(const CampaignFolder& folder,
                                                  const std::string& program,
                                                  const std::vector<std::int64_t>& shards,
                                                  const RunCampaignOptions& options);

/** Runs all shards of a campaign, as RunShards does. */
[[nodiscard]] Result<RunCampaignReport> RunCampaign(const CampaignFolder& folder,
                                                    const std::string& program,
                                                    const RunCampaignOptions& options);

}  // namespace hvas::campaign
