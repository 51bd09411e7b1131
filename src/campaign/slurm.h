#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "campaign/campaign_folder.h"

namespace hvas::campaign {

/** Options of a submission to SLURM. */
struct SlurmOptions {
  std::string hvas;      ///< Path of the program, as the nodes see it.
  int array_size{1000};  ///< Most tasks of an array, 1 to 4,000,000; SLURM's default allows 1001.
  std::vector<std::string> sbatch;  ///< Further options of sbatch, such as "--partition=long".
};

/** A submission that is written, and its command. */
struct Submission {
  std::filesystem::path script;
  std::int64_t shards{0};
  std::int64_t tasks{0};
  std::vector<std::string> command;  ///< sbatch with its options.
};

/** Lists the shards that are not there or are damaged, ascending. Reads all that are there. */
[[nodiscard]] std::vector<std::int64_t> ListUnfinished(const CampaignFolder& folder);

/** Writes the batch script and the list of its tasks, each with some shards that follow each other,
 into the folder `submissions`. Errors: kInvalid for an array size out of range; those of
 WriteAtomically. @pre shards is not empty. */
[[nodiscard]] Result<Submission> WriteSubmission(const CampaignFolder& folder,
                                                 const std::vector<std::int64_t>& shards,
                                                 const SlurmOptions& options);

/** Runs a command and returns what it prints, without the last line break. Errors: kNotFound where
 there is no such program, kUnsupported where it fails, with what it printed. */
[[nodiscard]] Result<std::string> RunCommand(const std::vector<std::string>& command);

/** Formats numbers as ranges: "0-3,7". @param numbers  Ascending. */
[[nodiscard]] std::string FormatRanges(const std::vector<std::int64_t>& numbers);

/** Parses ranges as FormatRanges writes them. Errors: kInvalid for other texts, or a number of
 `count` or more. */
[[nodiscard]] Result<std::vector<std::int64_t>> ParseRanges(const std::string& text,
                                                            std::int64_t count);

}  // namespace hvas::campaign
