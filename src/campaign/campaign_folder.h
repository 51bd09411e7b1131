#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "campaign/plan.h"
#include "campaign/shard.h"

namespace hvas::campaign {

/** Digest of what the results of a plan depend on: the bytes of the plan, of its CAD files and
 their side files, and the program. Errors: those of ReadRegularFile; kUnsupported for a folder of
 meshes.
 @param program  Version and build of the program. */
[[nodiscard]] Result<std::string> DigestInputs(const Plan& plan, const std::string& program);

/** The folder of a campaign: `campaign.json` (what it is of), `plan.yaml` (a copy), and the shards.
 Several processes and machines may use one folder at a time, as each file is written whole. */
class CampaignFolder {
 public:
  /** Makes a folder for a plan, or opens the one that is there. Of several programs that begin at
   once, one makes it, and the others open it. Errors: those of DigestInputs;
   kInvalid where the folder is that of another plan, product or program, or is no folder of a
   campaign and not empty; those of WriteAtomically. */
  [[nodiscard]] static Result<CampaignFolder> Make(const std::filesystem::path& path,
                                                   const Plan& plan, const std::string& program);

  /** Opens a folder. Errors: kNotFound where it has no campaign; kUnreadable for a damaged
   `campaign.json`; those of ParsePlan. */
  [[nodiscard]] static Result<CampaignFolder> Open(const std::filesystem::path& path);

  /** Checks that plan, CAD files, side files and program are those that the folder was made with.
   Errors: kInvalid where they are not; those of DigestInputs. */
  [[nodiscard]] Result<void> CheckInputs(const std::string& program) const;

  [[nodiscard]] const Plan& plan() const { return plan_; }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  [[nodiscard]] const std::string& inputs() const { return inputs_; }

  [[nodiscard]] const std::string& program() const { return program_; }

  [[nodiscard]] ShardKey MakeKey(std::int64_t shard) const { return {shard, inputs_}; }

  [[nodiscard]] std::filesystem::path PathOf(std::int64_t shard) const;

  /** Lists the shards without a file, ascending. What is in the files is not read. */
  [[nodiscard]] std::vector<std::int64_t> ListMissing() const;

 private:
  /** Opens a folder that has to be of these inputs. */
  [[nodiscard]] static Result<CampaignFolder> OpenSame(const std::filesystem::path& path,
                                                       const std::string& inputs,
                                                       const std::string& program);

  Plan plan_;
  std::filesystem::path path_;
  std::string inputs_;
  std::string program_;
};

/** How far a campaign has come, by its files. */
struct CampaignStatus {
  std::int64_t shards{0};
  std::int64_t done{0};
  std::int64_t runs{0};
  std::int64_t runs_done{0};
  /** Runs a second between the oldest and the newest shard; none for fewer than two shards. */
  std::optional<double> rate;
  std::optional<double> left;  ///< Time that the rest takes at this rate [s].
};

[[nodiscard]] CampaignStatus FindStatus(const CampaignFolder& folder);

}  // namespace hvas::campaign
