#include "campaign/campaign_folder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <span>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/digest.h"
#include "base/file_lock.h"
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

constexpr const char* kLockFile = "campaign.lock";

/** Whether the folder is new: it has nothing but what a program that is making it, or was killed
 while it did, has put there. Such a program has its lock file there until it is done. */
bool IsNew(const std::filesystem::path& path) {
  std::error_code failed;
  bool is_empty = true;
  for (const auto& entry : std::filesystem::directory_iterator(path, failed)) {
    const std::string name = entry.path().filename().string();
    // Files that WriteAtomically() has not finished have six more letters.
    if (name != kLockFile && !name.starts_with(kPlanCopy) && !name.starts_with(kFolderFile)) {
      return false;
    }
    is_empty = false;
  }
  // The lock file is looked for last: one that has come since the list was begun counts as well.
  return !failed && (is_empty || std::filesystem::exists(path / kLockFile, failed));
}

/** Locks the making of a folder, which takes some milliseconds: of two programs that begin at once,
 one makes it, and the other one finds it made. */
Result<Descriptor> LockMaking(const std::filesystem::path& path) {
  // Looked for a hundred times a second, up to 10 s for disks of a network: choices.
  constexpr std::chrono::milliseconds kPeriod{10};
  constexpr int kTries = 1000;
  int error = 0;
  for (int i = 0; i < kTries; ++i) {
    Descriptor file = OpenLocked(path / kLockFile, 0666, &error);
    if (file.is_open()) {
      return file;
    }
    if (error != EWOULDBLOCK) {
      return Fail(ErrorCode::kInvalid,
                  "the folder cannot be written: " +
                      std::error_code(error, std::generic_category()).message(),
                  path.string(), "check the path and its permissions");
    }
    std::this_thread::sleep_for(kPeriod);
  }
  return Fail(ErrorCode::kInvalid, "another program is making this folder", path.string(),
              "wait until it runs, or choose another folder with --folder");
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
  std::filesystem::create_directories(path, failed);
  if (failed) {
    return Fail(ErrorCode::kInvalid, "the folder cannot be made: " + failed.message(),
                path.string(), "check the path and its permissions");
  }
  const bool is_new = IsNew(path);
  // The folder's file is written last, before the lock file goes: looked for after the others, it
  // is there when another program has made the folder meanwhile.
  if (std::filesystem::exists(path / kFolderFile, failed)) {
    return OpenSame(path, *inputs, program);
  }
  if (!is_new) {
    return Fail(ErrorCode::kInvalid, "the folder is not empty, and has no campaign", path.string(),
                "choose another folder with --folder");
  }
  const auto lock = LockMaking(path);
  if (!lock) {
    return Unexpected(lock.error());
  }
  if (std::filesystem::exists(path / kFolderFile, failed)) {
    std::filesystem::remove(path / kLockFile, failed);
    return OpenSame(path, *inputs, program);
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
  if (!written) {
    return Unexpected(written.error());
  }
  std::filesystem::remove(path / kLockFile, failed);
  return Open(path);
}

Result<CampaignFolder> CampaignFolder::OpenSame(const std::filesystem::path& path,
                                                const std::string& inputs,
                                                const std::string& program) {
  auto folder = Open(path);
  if (!folder) {
    return folder;
  }
  const auto same = folder->CheckInputs(program);
  if (!same) {
    return Unexpected(same.error());
  }
  if (folder->inputs_ != inputs) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("the folder has the results of another plan, \"{}\", or of one that "
                            "was changed since",
                            folder->plan_.id),
                path.string(), "choose another folder with --folder");
  }
  return folder;
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
    if (!std::filesystem::is_regular_file(PathOf(shard), failed)) {
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
    if (failed || !std::filesystem::is_regular_file(folder.PathOf(shard), failed)) {
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
