#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/digest.h"
#include "base/result.h"
#include "campaign/run_result.h"

namespace hvas::campaign {

/** What the results of a shard depend on; two shards with equal keys have equal rows. */
struct ShardKey {
  std::int64_t shard{0};
  std::string inputs;  ///< Digest of plan, CAD files, side files and program.
};

/** Adds a row to a digest of rows. */
void AddRow(const RunResult& row, Digest* digest);

/** Relative path of a shard in the folder of a campaign: its number and its key, a thousand of them
 in each folder. */
[[nodiscard]] std::filesystem::path NameShard(const ShardKey& key);

/** Writes a shard as an SQLite file, whole or not at all; equal rows give equal bytes with one
 version of SQLite. Errors: those of WriteAtomically, kOutOfResource on a full disk among them. */
[[nodiscard]] Result<void> WriteShard(const std::filesystem::path& file, const ShardKey& key,
                                      const std::vector<RunResult>& rows);

/** Reads a shard, and checks its rows against their digest. Errors: kNotFound without a file;
 kUnreadable where it is damaged; kInvalid where it is of another plan, product or program. */
[[nodiscard]] Result<std::vector<RunResult>> ReadShard(const std::filesystem::path& file,
                                                       const ShardKey& key);

}  // namespace hvas::campaign
