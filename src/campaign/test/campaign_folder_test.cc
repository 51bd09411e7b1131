// Campaigns in their folders: shards, their digest, redoing, damage, and what is merged of them.

#include "campaign/campaign_folder.h"

#include <sys/stat.h>

#include <barrier>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/odd_files.h"
#include "base/test/temporary_folder.h"
#include "campaign/campaign_page.h"
#include "campaign/run_campaign.h"
#include "campaign/shard.h"
#include "campaign/slurm.h"
#include "campaign/summary.h"
#include "campaign/table_file.h"
#include "record/database.h"

namespace hvas::campaign {
namespace {

constexpr const char* kTestProgram = "test-1";

std::string ReadBytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class CampaignFolderTest : public ::testing::Test {
 protected:
  /** A plan of the bushing with two fits, 60 runs each. */
  Plan MakePlan(int shard_runs, const std::string& more = "") {
    const auto plan = ParsePlan(
        "format: hvas-campaign-1\n"
        "id: press\n"
        "products: [" HVAS_SOURCE_DIR
        "/products/bushing.step]\n"
        "fits: [{id: p6, assign: [all=H7/p6]}, {id: s6, assign: [all=H7/s6]}]\n"
        "seeds: {first: 3, count: 60}\n"
        "press_force_n: 9000\n"
        "shard_runs: " +
            std::to_string(shard_runs) + "\n" + more,
        scratch_ / "plan.yaml");
    EXPECT_TRUE(plan) << plan.error().ToString();
    return *plan;
  }

  CampaignFolder MakeFolder(const std::string& name, const Plan& plan) {
    const auto folder = CampaignFolder::Make(scratch_ / name, plan, kTestProgram);
    EXPECT_TRUE(folder) << folder.error().ToString();
    return *folder;
  }

  RunCampaignReport Run(const CampaignFolder& folder, unsigned jobs) {
    RunCampaignOptions options;
    options.jobs = jobs;
    options.open.cache_directory = scratch_ / "cache";
    const auto report = RunCampaign(folder, kTestProgram, options);
    EXPECT_TRUE(report) << report.error().ToString();
    return report.value_or(RunCampaignReport());
  }

  Summary CollectFolder(const CampaignFolder& folder, const std::filesystem::path& table = {}) {
    CollectOptions options;
    options.program = kTestProgram;
    options.table = table;
    options.open.cache_directory = scratch_ / "cache";
    const auto summary = Collect(folder, options);
    EXPECT_TRUE(summary) << summary.error().ToString();
    return summary.value_or(Summary());
  }

  hvas::testing::TemporaryFolder scratch_;
};

TEST_F(CampaignFolderTest, DigestDependsNeitherOnShardsNorOnJobs) {
  const CampaignFolder one = MakeFolder("one", MakePlan(1000));
  const CampaignFolder many = MakeFolder("many", MakePlan(7));
  EXPECT_EQ(Run(one, 1).calculated, 1);
  EXPECT_EQ(Run(many, 4).calculated, 18);
  const Summary summary = CollectFolder(one);
  EXPECT_EQ(summary.digest, CollectFolder(many).digest);
  EXPECT_EQ(summary.digest.size(), 32U);
  EXPECT_TRUE(summary.is_complete());
  ASSERT_EQ(summary.cells.size(), 2U);
  EXPECT_EQ(summary.cells[0].runs, 60);
  // A press fit of a wider interference needs more force, and fewer products can be assembled.
  EXPECT_LT(summary.cells[0].force_quantiles[1], summary.cells[1].force_quantiles[1]);
  EXPECT_GE(summary.cells[0].yield->share, summary.cells[1].yield->share);
  EXPECT_EQ(summary.cells[0].cost_rank, summary.cells[1].cost_rank);  // Of equal grades.
}

/** What several programs get that make a folder at once, for one plan each. */
std::vector<Result<CampaignFolder>> MakeAtOnce(const std::filesystem::path& path,
                                               const std::vector<Plan>& plans) {
  std::vector<std::optional<Result<CampaignFolder>>> made(plans.size());
  std::barrier begin(static_cast<std::ptrdiff_t>(plans.size()));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    threads.emplace_back([&, i] {
      begin.arrive_and_wait();
      made[i] = CampaignFolder::Make(path, plans[i], kTestProgram);
    });
  }
  std::vector<Result<CampaignFolder>> results;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    threads[i].join();
    results.push_back(*made[i]);
  }
  return results;
}

TEST_F(CampaignFolderTest, OfManyThatMakeItAtOnceAllShareIt) {
  const Plan plan = MakePlan(40);
  for (int round = 0; round < 20; ++round) {
    const auto path = scratch_ / ("fresh-" + std::to_string(round));
    for (const auto& folder : MakeAtOnce(path, std::vector<Plan>(8, plan))) {
      ASSERT_TRUE(folder) << folder.error().ToString();
      EXPECT_EQ(folder->plan().id, plan.id);
    }
    EXPECT_FALSE(std::filesystem::exists(path / "campaign.lock"));
  }
}

TEST_F(CampaignFolderTest, OfTwoPlansAtOnceOneHasItAndTheOtherIsRefused) {
  std::vector<Plan> plans(4, MakePlan(40));
  plans.resize(8, MakePlan(40, "may_yield: true\n"));
  for (int round = 0; round < 20; ++round) {
    const auto path = scratch_ / ("contended-" + std::to_string(round));
    const auto made = MakeAtOnce(path, plans);
    const bool has_first = made[0].has_value();
    for (std::size_t i = 0; i < made.size(); ++i) {
      EXPECT_EQ(made[i].has_value(), (i < 4) == has_first);
      if (!made[i]) {
        EXPECT_NE(made[i].error().message.find("another plan"), std::string::npos)
            << made[i].error().ToString();
      }
    }
    EXPECT_TRUE(CampaignFolder::Open(path)) << "what is there belongs together";
  }
}

TEST_F(CampaignFolderTest, AMakerThatWasKilledLeavesAFolderThatCanBeMade) {
  const Plan plan = MakePlan(40);
  std::filesystem::create_directory(scratch_ / "left");
  std::ofstream(scratch_ / "left" / "campaign.lock");
  std::ofstream(scratch_ / "left" / "plan.yaml") << "format: hvas-ca";
  std::ofstream(scratch_ / "left" / "campaign.json.aB3dEf") << "{";
  EXPECT_EQ(MakeFolder("left", plan).plan().id, plan.id);
  std::filesystem::create_directory(scratch_ / "foreign");
  std::ofstream(scratch_ / "foreign" / "plan.yaml") << "mine";
  const auto refused = CampaignFolder::Make(scratch_ / "foreign", plan, kTestProgram);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("not empty"), std::string::npos);
  EXPECT_EQ(ReadBytes(scratch_ / "foreign" / "plan.yaml"), "mine");
}

TEST_F(CampaignFolderTest, AShardThatIsNoFileIsNamedAndNotWaitedFor) {
  const CampaignFolder folder = MakeFolder("odd", MakePlan(40));
  Run(folder, 1);
  const std::filesystem::path shard = folder.PathOf(1);
  for (const auto& odd : hvas::testing::MakeOddFiles(scratch_ / "odd-files", "shard")) {
    std::filesystem::remove(shard);
    std::filesystem::create_symlink(odd.path, shard);
    const Summary summary = CollectFolder(folder);
    ASSERT_EQ(summary.damaged.size(), 1U) << odd.kind;
    EXPECT_NE(summary.damaged[0].second.find("this is " + odd.kind), std::string::npos)
        << summary.damaged[0].second;
  }
  std::filesystem::remove(shard);
  std::filesystem::create_symlink(shard, shard);  // It leads to itself.
  EXPECT_FALSE(ReadShard(shard, folder.MakeKey(1)));
}

TEST_F(CampaignFolderTest, TableReplacesNoFileThatIsNone) {
  const auto file = scratch_ / "precious.txt";
  std::ofstream(file) << "precious";
  const auto refused = TableFile::Create(file);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalid);
  EXPECT_FALSE(refused.error().remedy.empty());
  const auto pipe = scratch_ / "pipe.sqlite";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_FALSE(TableFile::Create(pipe));
  std::string kept;
  std::getline(std::ifstream(file), kept);
  EXPECT_EQ(kept, "precious");
}

TEST_F(CampaignFolderTest, OfTwoThatWriteOneTableTheSecondIsRefused) {
  auto first = TableFile::Create(scratch_ / "rows.sqlite");
  ASSERT_TRUE(first) << first.error().ToString();
  const auto second = TableFile::Create(scratch_ / "rows.sqlite");
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another program is writing this table"),
            std::string::npos);
  EXPECT_TRUE(first->Finish());
  EXPECT_TRUE(TableFile::Create(scratch_ / "rows.sqlite"));
}

TEST_F(CampaignFolderTest, AShardDoneAgainHasTheSameBytes) {
  const CampaignFolder folder = MakeFolder("again", MakePlan(40));
  Run(folder, 1);
  const std::string bytes = ReadBytes(folder.PathOf(1));
  ASSERT_FALSE(bytes.empty());
  std::filesystem::remove(folder.PathOf(1));
  EXPECT_EQ(folder.ListMissing(), std::vector<std::int64_t>{1});
  const RunCampaignReport report = Run(folder, 2);
  EXPECT_EQ(report.calculated, 1);
  EXPECT_EQ(report.kept, 2);
  EXPECT_EQ(ReadBytes(folder.PathOf(1)), bytes);
}

TEST_F(CampaignFolderTest, ADamagedShardIsFoundAndCalculatedAnew) {
  const CampaignFolder folder = MakeFolder("damaged", MakePlan(40));
  Run(folder, 1);
  const std::string digest = CollectFolder(folder).digest;
  const std::string bytes = ReadBytes(folder.PathOf(2));
  for (const std::size_t at : {bytes.size() - 5, bytes.size() / 2, std::size_t{3}}) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    std::ofstream(folder.PathOf(2), std::ios::binary) << damaged;
    const bool is_harmless = ReadShard(folder.PathOf(2), folder.MakeKey(2)).has_value();
    if (!is_harmless) {  // A byte of free space in a page is of no row.
      const Summary summary = CollectFolder(folder);
      ASSERT_EQ(summary.damaged.size(), 1U) << at;
      EXPECT_EQ(summary.damaged[0].first, 2);
      EXPECT_NE(summary.damaged[0].second.find("damaged"), std::string::npos);
      EXPECT_EQ(ListUnfinished(folder), std::vector<std::int64_t>{2});
      EXPECT_EQ(Run(folder, 1).damaged.size(), 1U);
    }
    EXPECT_EQ(CollectFolder(folder).digest, digest);
  }
  std::filesystem::resize_file(folder.PathOf(2), bytes.size() / 2);
  EXPECT_EQ(CollectFolder(folder).damaged.size(), 1U);
  Run(folder, 1);
  EXPECT_EQ(CollectFolder(folder).digest, digest);
}

TEST_F(CampaignFolderTest, CollectingNamesWhatIsMissing) {
  const CampaignFolder folder = MakeFolder("missing", MakePlan(20));
  RunCampaignOptions options;
  ASSERT_TRUE(RunShards(folder, kTestProgram, {0, 2, 5}, options));
  const Summary summary = CollectFolder(folder);
  EXPECT_EQ(summary.missing, (std::vector<std::int64_t>{1, 3, 4}));
  EXPECT_EQ(summary.runs_done, 60);
  EXPECT_FALSE(summary.is_complete());
  const CampaignStatus status = FindStatus(folder);
  EXPECT_EQ(status.done, 3);
  EXPECT_EQ(status.shards, 6);
  EXPECT_EQ(status.runs_done, 60);
}

TEST_F(CampaignFolderTest, TheTableHasAllRows) {
  const CampaignFolder folder = MakeFolder("table", MakePlan(50));
  Run(folder, 1);
  const std::filesystem::path table = scratch_ / "runs.sqlite";
  CollectFolder(folder, table);
  auto database = record::Database::Open(table, record::Database::Mode::kReadOnly);
  ASSERT_TRUE(database);
  EXPECT_EQ(database->QueryInt("SELECT count(*) FROM runs").value(), 120);
  EXPECT_EQ(database->QueryInt("SELECT max(seed) FROM runs").value(), 62);
  EXPECT_FALSE(std::filesystem::exists(table.string() + ".unfinished"));
}

TEST_F(CampaignFolderTest, ATableThatCannotBeWrittenIsAnErrorAndTheShardsStay) {
  const CampaignFolder folder = MakeFolder("full", MakePlan(50));
  Run(folder, 1);
  CollectOptions options;
  options.program = kTestProgram;
  options.table = scratch_ / "nowhere" / "runs.sqlite";
  const auto summary = Collect(folder, options);
  ASSERT_FALSE(summary);
  EXPECT_FALSE(summary.error().remedy.empty());
  EXPECT_TRUE(folder.ListMissing().empty());
}

TEST_F(CampaignFolderTest, AShardThatIsAPipeOrHasOtherTablesIsDamagedAndIsNeverWaitedFor) {
  const CampaignFolder folder = MakeFolder("strange", MakePlan(50));
  Run(folder, 1);
  const std::filesystem::path pipe = folder.PathOf(0);
  std::filesystem::remove(pipe);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::filesystem::path more = folder.PathOf(1);
  auto database = record::Database::Open(more, record::Database::Mode::kCreate);
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->Execute("CREATE VIEW more AS SELECT * FROM runs"));
  for (const std::int64_t shard : {0, 1}) {
    const auto rows = ReadShard(folder.PathOf(shard), folder.MakeKey(shard));
    ASSERT_FALSE(rows) << shard;
    EXPECT_EQ(rows.error().code, ErrorCode::kUnreadable);
    EXPECT_NE(rows.error().message.find(shard == 0 ? "pipe" : "\"more\""), std::string::npos)
        << rows.error().message;
  }
  std::filesystem::remove(pipe);  // Nothing is written over what is no file.
  EXPECT_EQ(Run(folder, 1).calculated, 2);
}

TEST_F(CampaignFolderTest, AnotherPlanProgramOrProductIsRefused) {
  const Plan plan = MakePlan(50);
  MakeFolder("ours", plan);
  const auto other = CampaignFolder::Make(scratch_ / "ours", MakePlan(51), kTestProgram);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("another plan"), std::string::npos);
  const auto newer = CampaignFolder::Make(scratch_ / "ours", plan, "test-2");
  ASSERT_FALSE(newer);
  EXPECT_NE(newer.error().message.find("another version"), std::string::npos);
  EXPECT_FALSE(CampaignFolder::Open(scratch_ / "nothing"));

  const std::filesystem::path copy = scratch_ / "copy.step";
  std::filesystem::copy_file(HVAS_SOURCE_DIR "/products/bushing.step", copy);
  Plan moved = plan;
  moved.text = "format: hvas-campaign-1\nid: moved\nproducts: [copy.step]\nseeds: {count: 5}\n";
  moved = ParsePlan(moved.text, scratch_ / "moved.yaml").value();
  const CampaignFolder folder = MakeFolder("moved", moved);
  std::ofstream(copy, std::ios::app) << " ";
  const auto changed = folder.CheckInputs(kTestProgram);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().message.find("CAD file"), std::string::npos);
}

TEST_F(CampaignFolderTest, TheSizesOfAFitExplainItsForce) {
  const CampaignFolder folder =
      MakeFolder("effects", MakePlan(1000, "sensitivity: {samples: 512, resamples: 100}\n"));
  Run(folder, 1);
  const Summary summary = CollectFolder(folder);
  ASSERT_EQ(summary.cells.size(), 2U);
  const CellSummary& cell = summary.cells[1];
  ASSERT_FALSE(cell.effects.empty());
  ASSERT_FALSE(cell.sobol.empty());
  double total = 0;
  for (const SobolOfFactor& factor : cell.sobol) {
    ASSERT_TRUE(factor.force) << factor.factor;
    total += factor.force->first;
  }
  // The force is nearly a sum over the sizes: the first-order indices are nearly all.
  EXPECT_NEAR(total, 1, 0.25);
  const std::string page = MakeCampaignPage(folder.plan(), summary);
  EXPECT_NE(page.find("Cost class against yield"), std::string::npos);
  EXPECT_NE(page.find("hvas assemble"), std::string::npos);
  EXPECT_EQ(page, MakeCampaignPage(folder.plan(), summary));
}

TEST_F(CampaignFolderTest, ASubmissionHasEachShardOnce) {
  const CampaignFolder folder = MakeFolder("slurm", MakePlan(5));
  const std::vector<std::int64_t> shards{0, 1, 2, 3, 5, 6, 7, 20};
  const auto submission = WriteSubmission(folder, shards, {"/bin/hvas", 3, {"--partition=x"}});
  ASSERT_TRUE(submission) << submission.error().ToString();
  EXPECT_EQ(submission->tasks, 3);
  const std::string tasks = ReadBytes(submission->script.parent_path() / "tasks");
  EXPECT_EQ(tasks, "0-2\n3,5-6\n7,20\n");
  EXPECT_NE(ReadBytes(submission->script).find("campaign shard"), std::string::npos);
  EXPECT_EQ(submission->command.back(), submission->script.string());
}

TEST(ShardRanges, AreWrittenAndRead) {
  const std::vector<std::int64_t> numbers{0, 1, 2, 5, 7, 8};
  EXPECT_EQ(FormatRanges(numbers), "0-2,5,7-8");
  EXPECT_EQ(ParseRanges("0-2,5,7-8", 9).value(), numbers);
  for (const char* text : {"", "9", "-1", "3-2", "1,", "a", "1;2"}) {
    EXPECT_FALSE(ParseRanges(text, 9)) << text;
  }
}

TEST(ForceCounts, QuantilesAreWithinHalfAPerCent) {
  ForceCounts counts;
  for (int i = 1; i <= 1000; ++i) {
    counts.Add(i);
  }
  for (const double p : {0.05, 0.5, 0.95, 0.99, 1.0}) {
    EXPECT_NEAR(counts.Quantile(p), 1000 * p, 5 * p) << p;
  }
  counts.Add(0);
  EXPECT_EQ(counts.Quantile(0), 0);
  EXPECT_EQ(ForceCounts().Quantile(0.5), 0);
}

}  // namespace
}  // namespace hvas::campaign
