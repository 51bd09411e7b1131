#include "app/campaign/campaign.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "app/campaign/campaign_report.h"
#include "app/command_line.h"
#include "app/end_watch.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/text_layout.h"
#include "app/product/load_product.h"
#include "app/recording/page_file.h"
#include "base/clock.h"
#include "base/digest.h"
#include "base/regular_file.h"
#include "campaign/campaign_page.h"
#include "campaign/run_campaign.h"
#include "campaign/slurm.h"
#include "campaign/summary.h"

namespace hvas::app {
namespace {

using campaign::CampaignFolder;

constexpr int kUnfinished = 2;  // The exit status where shards are missing or damaged.
constexpr const char* kThisProgram = "/proc/self/exe";

struct CampaignOptions {
  std::filesystem::path plan;
  std::filesystem::path folder;
  unsigned jobs{0};
  std::filesystem::path page;
  std::filesystem::path table;
  std::filesystem::path record;
  bool is_forced{false};
  bool is_json{false};
  bool is_quiet{false};
  bool is_cache_used{true};
  bool is_dry{false};
  std::string shards;
  std::int64_t run{0};
  int array_size{campaign::SlurmOptions().array_size};  ///< Tasks of an array: that default.
  std::vector<std::string> sbatch;
};

/** Version and build of this program: results of different builds are not mixed. */
Result<std::string> DescribeProgram() {
  const auto bytes = ReadRegularFile(std::filesystem::canonical(kThisProgram));
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  return fmt::format("{}-{:016x}", Version(), Checksum64(std::as_bytes(std::span(*bytes))));
}

assembly::OpenOptions MakeCampaignOpenOptions(const CampaignOptions& options) {
  LoadOptions load;
  load.is_cache_used = options.is_cache_used;
  load.cache_directory = CacheDirectory(load);
  return load;
}

/** Calls of the stages of a campaign, with progress for a person who watches. */
class CampaignStages {
 public:
  CampaignStages(const CampaignOptions* options, std::stop_token stop)
      : options_(options), stop_(std::move(stop)) {}

  /** Reads the program's own bytes. */
  Result<void> Begin() {
    auto program = DescribeProgram();
    if (!program) {
      return Unexpected(program.error());
    }
    program_ = *std::move(program);
    return {};
  }

  Result<CampaignFolder> MakeFolder() {
    const auto plan = campaign::ReadPlan(options_->plan);
    if (!plan) {
      return Unexpected(plan.error());
    }
    const std::filesystem::path path =
        options_->folder.empty() ? std::filesystem::path(plan->id) : options_->folder;
    return CampaignFolder::Make(path, *plan, program_);
  }

  Result<campaign::RunCampaignReport> Run(const CampaignFolder& folder,
                                          const std::vector<std::int64_t>* shards) {
    campaign::RunCampaignOptions run;
    run.jobs = options_->jobs;
    run.open = MakeCampaignOpenOptions(*options_);
    run.stop = stop_;
    const bool is_shown = !options_->is_quiet && IsWatched();
    if (is_shown) {
      run.progress = [](std::int64_t done, std::int64_t total) {
        ShowProgress(fmt::format("run {} of {}", done, total),
                     static_cast<double>(done) / static_cast<double>(total));
      };
    }
    auto report = shards == nullptr ? campaign::RunCampaign(folder, program_, run)
                                    : campaign::RunShards(folder, program_, *shards, run);
    if (is_shown) {
      ShowProgress("runs", 1);
    }
    return report;
  }

  Result<campaign::Summary> Collect(const CampaignFolder& folder) {
    campaign::CollectOptions collect;
    collect.program = program_;
    collect.open = MakeCampaignOpenOptions(*options_);
    collect.table = options_->table;
    collect.stop = stop_;
    const bool is_shown = !options_->is_quiet && IsWatched();
    if (is_shown) {
      collect.progress = [](double fraction) { ShowProgress("collecting", fraction); };
    }
    auto summary = campaign::Collect(folder, collect);
    if (is_shown) {
      ShowProgress("collecting", 1);
    }
    return summary;
  }

  [[nodiscard]] const std::string& program() const { return program_; }

 private:
  const CampaignOptions* options_;
  std::stop_token stop_;
  std::string program_;
};

/** Collects a folder, and writes what is asked for. @returns the exit status. */
int ReportCampaign(CampaignStages* stages, const CampaignFolder& folder,
                   const CampaignOptions& options, std::optional<double> wall_s) {
  const auto summary = stages->Collect(folder);
  if (!summary) {
    return ReportFailure(summary.error());
  }
  if (options.is_json) {
    auto json = MakeCampaignJson(folder.plan(), *summary);
    json["folder"] = folder.path().string();
    json["wall_s"] = wall_s ? nlohmann::ordered_json(*wall_s) : nlohmann::ordered_json(nullptr);
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", MakeCampaignText(folder.plan(), *summary));
    if (wall_s) {
      fmt::print("In {:.1f} s. Folder: {}\n", *wall_s, folder.path().string());
    }
  }
  if (!options.page.empty()) {
    const auto written =
        WritePage(options.page, campaign::MakeCampaignPage(folder.plan(), *summary));
    if (!written) {
      return ReportFailure(written.error());
    }
  }
  return summary->is_complete() ? 0 : kUnfinished;
}

int RunPlan(const CampaignOptions& options) {
  const EndWatch end;
  CampaignStages stages(&options, end.stop());
  Result<void> good =
      options.page.empty() ? Result<void>() : CheckPageFile(options.page, options.is_forced);
  good = good ? stages.Begin() : good;
  const auto folder = good ? stages.MakeFolder() : Unexpected(good.error());
  if (!folder) {
    return ReportFailure(folder.error());
  }
  const std::int64_t start_ns = MonotonicNs();
  const auto report = stages.Run(*folder, nullptr);
  if (!report) {
    return ReportFailure(report.error());
  }
  for (const std::string& damaged : report->damaged) {
    fmt::print(stderr, "{}", Fold("hvas: calculated anew: " + damaged + "\n"));
  }
  const double wall_s = 1e-9 * static_cast<double>(MonotonicNs() - start_ns);
  return ReportCampaign(&stages, *folder, options, wall_s);
}

int RunSomeShards(const CampaignOptions& options) {
  const EndWatch end;
  CampaignStages stages(&options, end.stop());
  const auto good = stages.Begin();
  const auto folder = good ? CampaignFolder::Open(options.folder) : Unexpected(good.error());
  if (!folder) {
    return ReportFailure(folder.error());
  }
  const auto shards = campaign::ParseRanges(options.shards, folder->plan().CountShards());
  if (!shards) {
    return ReportFailure(shards.error());
  }
  const auto report = stages.Run(*folder, &*shards);
  if (!report) {
    return ReportFailure(report.error());
  }
  if (!options.is_quiet) {
    fmt::print("{} shards calculated, {} were there\n", report->calculated, report->kept);
  }
  return 0;
}

int PrintStatus(const CampaignOptions& options) {
  const auto folder = CampaignFolder::Open(options.folder);
  if (!folder) {
    return ReportFailure(folder.error());
  }
  const auto status = campaign::FindStatus(*folder);
  if (options.is_json) {
    fmt::print("{}\n", MakeStatusJson(*folder, status).dump(2));
  } else {
    fmt::print("{}", MakeStatusText(*folder, status));
  }
  return 0;
}

int CollectFolder(const CampaignOptions& options) {
  const EndWatch end;
  CampaignStages stages(&options, end.stop());
  Result<void> good =
      options.page.empty() ? Result<void>() : CheckPageFile(options.page, options.is_forced);
  good = good ? stages.Begin() : good;
  const auto folder = good ? CampaignFolder::Open(options.folder) : Unexpected(good.error());
  return folder ? ReportCampaign(&stages, *folder, options, std::nullopt)
                : ReportFailure(folder.error());
}

int Submit(const CampaignOptions& options) {
  CampaignStages stages(&options, {});
  const auto good = stages.Begin();
  const auto folder = good ? stages.MakeFolder() : Unexpected(good.error());
  if (!folder) {
    return ReportFailure(folder.error());
  }
  const auto shards = [&] {
    const Busy busy("reading the shards that are there");
    return campaign::ListUnfinished(*folder);
  }();
  nlohmann::ordered_json json{{"schema", "hvas-campaign-submission-1"},
                              {"folder", folder->path().string()},
                              {"shards", shards.size()},
                              {"tasks", 0},
                              {"job", nullptr},
                              {"command", nullptr}};
  if (!shards.empty()) {
    const auto submission = campaign::WriteSubmission(
        *folder, shards,
        {std::filesystem::canonical(kThisProgram).string(), options.array_size, options.sbatch});
    if (!submission) {
      return ReportFailure(submission.error());
    }
    json["tasks"] = submission->tasks;
    json["command"] = submission->command;
    if (!options.is_dry) {
      const auto job = campaign::RunCommand(submission->command);
      if (!job) {
        return ReportFailure(job.error());
      }
      json["job"] = *job;
    }
  }
  if (options.is_json) {
    fmt::print("{}\n", json.dump(2));
  } else if (shards.empty()) {
    fmt::print("All shards are there: hvas campaign collect {}\n", folder->path().string());
  } else {
    const auto command = json["command"].get<std::vector<std::string>>();
    fmt::print("{} shards in {} tasks, {}\n", shards.size(), json["tasks"].get<std::int64_t>(),
               options.is_dry ? fmt::format("not submitted: {}", fmt::join(command, " "))
                              : "job " + json["job"].get<std::string>());
  }
  return 0;
}

int PlayOneRun(const CampaignOptions& options) {
  const EndWatch end;
  const auto plan = campaign::ReadPlan(options.plan);
  if (!plan) {
    return ReportFailure(plan.error());
  }
  if (options.run < 0 || options.run >= plan->CountRuns()) {
    return ReportFailure(Error{ErrorCode::kInvalid, fmt::format("there is no run {}", options.run),
                               options.plan.string(),
                               fmt::format("give 0 to {}", plan->CountRuns() - 1)});
  }
  campaign::CellStore cells(&*plan, MakeCampaignOpenOptions(options));
  const auto cell = cells.Prepare(options.run / plan->seeds.count);
  if (!cell) {
    return ReportFailure(cell.error());
  }
  const std::uint64_t seed =
      plan->seeds.first + static_cast<std::uint64_t>(options.run % plan->seeds.count);
  const auto result = [&] {
    const Busy busy("assembling");
    return campaign::PlayRun(**cell, *plan, seed,
                             {options.record, options.is_forced, cells.shapes(), end.stop()});
  }();
  if (!result) {
    return ReportFailure(result.error());
  }
  fmt::print("run {}, seed {}: {}, force {:.4g} N, {:.3g} s\n", options.run, seed,
             result->is_complete ? "all parts in place" : "NOT COMPLETE", result->force,
             result->time);
  return result->is_complete ? 0 : kUnfinished;
}

using Options = std::shared_ptr<CampaignOptions>;

void AddPlanArgument(CLI::App* command, const Options& options) {
  command->add_option("plan", options->plan, "Plan: a YAML file (docs/campaigns.md)")->required();
}

void AddFolderArgument(CLI::App* command, const Options& options) {
  command->add_option("folder", options->folder, "Folder of the campaign")->required();
}

void AddFolderOption(CLI::App* command, const Options& options) {
  command->add_option("--folder", options->folder,
                      "Folder of the campaign; default: the plan's id. Results that are there are "
                      "kept");
}

void AddRunningOptions(CLI::App* command, const Options& options) {
  command
      ->add_option("--jobs,-j", options->jobs,
                   "Shards to calculate at a time; 0: one for each core")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->add_flag("!--no-cache", options->is_cache_used,
                    "Do not use the caches on disk: read and prepare everything again");
}

void AddResultOptions(CLI::App* command, const Options& options) {
  command->add_option("-o,--output", options->page,
                      "Page of results to write: .html, or .pdf (printed by Chromium)");
  command->add_flag("--force", options->is_forced, "Replace an existing page");
  command->add_option("--table", options->table, "SQLite file for the rows of all runs");
  AddJsonFlag(command, &options->is_json, "campaign_summary");
}

void AddRunPlan(CLI::App* group, int* status) {
  CLI::App* command =
      group->add_subcommand("run", "Run a plan on this machine, and collect its results");
  const auto options = std::make_shared<CampaignOptions>();
  AddPlanArgument(command, options);
  AddFolderOption(command, options);
  AddRunningOptions(command, options);
  AddResultOptions(command, options);
  command->footer(
      "A campaign that was interrupted is resumed by running it again; damaged shards\n"
      "are calculated anew. The digest does not depend on --jobs.\n"
      "Examples:\n"
      "  hvas campaign run press.yaml -o press.html\n"
      "  hvas campaign run press.yaml --jobs 2 --json | jq '.cells[] | .name, .yield'\n"
      "  hvas campaign run press.yaml --table runs.sqlite");
  command->callback([options, status] { *status = RunPlan(*options); });
}

void AddShard(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "shard", "Calculate some shards of a folder: what a job of a cluster calls");
  const auto options = std::make_shared<CampaignOptions>();
  AddFolderArgument(command, options);
  command->add_option("shards", options->shards, "Numbers of shards: 7, or 0-3,7")->required();
  AddRunningOptions(command, options);
  command->footer(
      "Shards that are there are kept. A shard calculated twice has the same rows.\n"
      "Examples:\n"
      "  hvas campaign shard press 0-3\n"
      "  seq 0 99 | xargs -P 4 -I % hvas campaign shard press % --jobs 1");
  command->callback([options, status] { *status = RunSomeShards(*options); });
}

void AddStatus(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand("status", "Show how far a campaign is, and how fast");
  const auto options = std::make_shared<CampaignOptions>();
  AddFolderArgument(command, options);
  AddJsonFlag(command, &options->is_json, "campaign_status");
  command->footer("Example:\n  watch hvas campaign status press");
  command->callback([options, status] { *status = PrintStatus(*options); });
}

void AddCollect(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "collect", "Merge the shards that are there, and name those that are not");
  const auto options = std::make_shared<CampaignOptions>();
  AddFolderArgument(command, options);
  AddResultOptions(command, options);
  command->add_flag("--quiet,-q", options->is_quiet, "No progress");
  command->footer(
      "Exit status: 0 when all shards are there, 2 when some are missing or damaged.\n"
      "Examples:\n"
      "  hvas campaign collect press -o press.html\n"
      "  hvas campaign collect press --json | jq .missing_shards");
  command->callback([options, status] { *status = CollectFolder(*options); });
}

void AddSubmit(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "submit", "Submit the shards of a plan that are not there to SLURM, as an array of jobs");
  const auto options = std::make_shared<CampaignOptions>();
  AddPlanArgument(command, options);
  AddFolderOption(command, options);
  command
      ->add_option("--array-size", options->array_size,
                   "Most tasks of the array; more shards share a task. SLURM allows 1001 unless "
                   "MaxArraySize says otherwise")
      ->check(CLI::Range(1, 4'000'000))
      ->capture_default_str();
  command->add_option("--sbatch", options->sbatch,
                      "Option for sbatch, for example --sbatch=--partition=long; may be repeated");
  command->add_flag("--dry-run", options->is_dry, "Write the script, and submit nothing");
  AddJsonFlag(command, &options->is_json, "campaign_submission");
  command->footer(
      "The folder, the CAD files and the program have to have the same paths on all\n"
      "nodes. Tasks whose node fails are put into the queue again. Submit again to\n"
      "resume what is missing.\n"
      "Examples:\n"
      "  hvas campaign submit press.yaml --folder /shared/press\n"
      "  hvas campaign submit press.yaml --sbatch=--partition=long --sbatch=--time=60");
  command->callback([options, status] { *status = Submit(*options); });
}

void AddPlay(CLI::App* group, int* status) {
  CLI::App* command = group->add_subcommand(
      "play", "Assemble the product of one run with the whole haptic tick, and record it");
  const auto options = std::make_shared<CampaignOptions>();
  AddPlanArgument(command, options);
  command->add_option("run", options->run, "Number of the run")->check(NotNegative())->required();
  command->add_option("--record", options->record, "Record the session to this file");
  command->add_flag("--force", options->is_forced, "Replace an existing record");
  command->footer(
      "Exit status: 0 when every part is in its place, 2 when one is not.\n"
      "Example:\n  hvas campaign play press.yaml 4711 --record worst.hvasrec");
  command->callback([options, status] { *status = PlayOneRun(*options); });
}

}  // namespace

void AddCampaign(CLI::App* app, int* status) {
  CLI::App* group =
      app->add_subcommand("campaign", "Run products by the thousand within their tolerances");
  group->require_subcommand(1);
  AddRunPlan(group, status);
  AddSubmit(group, status);
  AddStatus(group, status);
  AddCollect(group, status);
  AddShard(group, status);
  AddPlay(group, status);
}

}  // namespace hvas::app
