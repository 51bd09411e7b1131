#include "campaign/campaign_folder.h"

#include <algorithm>
#include <chrono>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/digest.h"
#include "base/parse_json.h"
#include "base/regular_file.h"
#include "mates/side_file.h"

namespace hvas::campaign {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFolderSchema = "hvas-campaign-folder-1";
constexpr const char* kFolderFile = "campaign.json";
constexpr const char* kPlanCopy = "plan.yaml";
constexpr std::size_t kLargestFolderFile = 100'000;  // [bytes]: it has a dozen lines. A choice.

Result<void> AddFile(const std::filesystem::path& file, Digest* digest) {
  std::error_code failed;
  if (std::filesystem::is_directory(file, failed)) {
    return Fail(ErrorCode::kUnsupported, "a campaign takes no folder of meshes", file.string(),
                "name a single CAD file");
  }
  const auto bytes = ReadRegularFile(file);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  digest->AddText(*bytes);
  return {};
}

Unexpected FailFolder(const std::filesystem::path& file, const std::string& what) {
  return Fail(ErrorCode::kUnreadable, "the file of the campaign is damaged: " + what, file.string(),
              "restore it, or use a new folder");
}

}  // namespace

Result<std::string> DigestInputs(const Plan& plan, const std::string& program) {
  Digest digest;
  digest.AddText(plan.text);
  digest.AddText(program);
  for (const std::filesystem::path& product : plan.products) {
    if (const auto added = AddFile(product, &digest); !added) {
      return Unexpected(added.error());
    }
    std::error_code failed;
    const std::filesystem::path side = mates::FindAssignmentFile(product);
    const bool has_side = std::filesystem::exists(side, failed);
    digest.AddInt(has_side ? 1 : 0);
    const auto added = has_side ? AddFile(side, &digest) : Result<void>();
    if (!added) {
      return Unexpected(added.error());
    }
  }
  return digest.Hex();
}

Result<CampaignFolder> CampaignFolder::Make(const std::filesystem::path& path, const Plan& plan,
                                            const std::string& program) {
  const auto inputs = DigestInputs(plan, program);
  if (!inputs) {
    return Unexpected(inputs.error());
  }
  std::error_code failed;
  if (std::filesystem::exists(path / kFolderFile, failed)) {
    auto folder = Open(path);
    if (!folder) {
      return folder;
    }
    const auto same = folder->CheckInputs(program);
    if (!same) {
      return Unexpected(same.error());
    }
    if (folder->inputs_ != *inputs) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("the folder has the results of another plan, \"{}\", or of one that "
                              "was changed since",
                              folder->plan_.id),
                  path.string(), "choose another folder with --folder");
    }
    return folder;
  }
  if (std::filesystem::exists(path, failed) && !std::filesystem::is_empty(path, failed)) {
    return Fail(ErrorCode::kInvalid, "the folder is not empty, and has no campaign", path.string(),
                "choose another folder with --folder");
  }
  std::filesystem::create_directories(path, failed);
  if (failed) {
    return Fail(ErrorCode::kInvalid, "the folder cannot be made: " + failed.message(),
                path.string(), "check the path and its permissions");
  }
  const Json json{{"schema", kFolderSchema},
                  {"id", plan.id},
                  {"plan", std::filesystem::absolute(plan.file).string()},
                  {"inputs", *inputs},
                  {"program", program},
                  {"runs", plan.CountRuns()},
                  {"shards", plan.CountShards()}};
  auto written = WriteAtomically(path / kPlanCopy, plan.text);
  written = written ? WriteAtomically(path / kFolderFile, json.dump(2) + "\n") : written;
  return written ? Open(path) : Unexpected(written.error());
}

Result<CampaignFolder> CampaignFolder::Open(const std::filesystem::path& path) {
  const std::filesystem::path file = path / kFolderFile;
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) {
    return Fail(ErrorCode::kNotFound, "this is not the folder of a campaign", path.string(),
                "name the folder that `hvas campaign run` or `submit` has made");
  }
  const auto text = ReadRegularFile(file, kLargestFolderFile);
  const auto copy = ReadRegularFile(path / kPlanCopy);
  if (!text || !copy) {
    return Unexpected((text ? copy : text).error());
  }
  const Json json = ParseJson<Json>(*text);
  if (!json.is_object() || json.value("schema", "") != kFolderSchema) {
    return FailFolder(file, "it has no campaign");
  }
  CampaignFolder folder;
  try {
    folder.inputs_ = json.at("inputs").get<std::string>();
    folder.program_ = json.at("program").get<std::string>();
    auto plan = ParsePlan(*copy, json.at("plan").get<std::string>());
    if (!plan) {
      return Unexpected(plan.error());
    }
    folder.plan_ = *std::move(plan);
  } catch (const Json::exception& exception) {
    return FailFolder(file, exception.what());
  }
  folder.path_ = path;
  return folder;
}

Result<void> CampaignFolder::CheckInputs(const std::string& program) const {
  if (program != program_) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the folder was made by another version or build of HVAS ({}, this is "
                            "{})",
                            program_, program),
                path_.string(), "use that program, or a new folder with --folder");
  }
  const auto inputs = DigestInputs(plan_, program);
  if (!inputs) {
    return Unexpected(inputs.error());
  }
  if (*inputs != inputs_) {
    return Fail(ErrorCode::kInvalid,
                "a CAD file of the plan or its side file was changed since the folder was made",
                path_.string(), "restore the files, or use a new folder with --folder");
  }
  return {};
}

std::filesystem::path CampaignFolder::PathOf(std::int64_t shard) const {
  return path_ / NameShard(MakeKey(shard));
}

std::vector<std::int64_t> CampaignFolder::ListMissing() const {
  std::vector<std::int64_t> missing;
  for (std::int64_t shard = 0; shard < plan_.CountShards(); ++shard) {
    std::error_code failed;
    if (!std::filesystem::exists(PathOf(shard), failed)) {
      missing.push_back(shard);
    }
  }
  return missing;
}

CampaignStatus FindStatus(const CampaignFolder& folder) {
  using Clock = std::filesystem::file_time_type::clock;
  const Plan& plan = folder.plan();
  CampaignStatus status;
  status.shards = plan.CountShards();
  status.runs = plan.CountRuns();
  Clock::time_point oldest = Clock::time_point::max();
  Clock::time_point newest = Clock::time_point::min();
  for (std::int64_t shard = 0; shard < status.shards; ++shard) {
    std::error_code failed;
    const auto written = std::filesystem::last_write_time(folder.PathOf(shard), failed);
    if (failed) {
      continue;
    }
    const RunRange runs = FindRuns(plan, shard);
    ++status.done;
    status.runs_done += runs.end - runs.first;
    oldest = std::min(oldest, written);
    newest = std::max(newest, written);
  }
  const double span = status.done > 1 ? std::chrono::duration<double>(newest - oldest).count() : 0;
  if (span > 0) {
    // The runs of the oldest shard were done before this span.
    const double share = static_cast<double>(status.done - 1) / static_cast<double>(status.done);
    status.rate = share * static_cast<double>(status.runs_done) / span;
    status.left = static_cast<double>(status.runs - status.runs_done) / *status.rate;
  }
  return status;
}

}  // namespace hvas::campaign
