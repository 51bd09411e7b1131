// Records that are not as they were written, cannot be written, or must not be replaced.

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "record/reader.h"

namespace hvas::app {
namespace {

namespace fs = std::filesystem;

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ProductFile;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;

void Tamper(const std::string& file, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_GE(sqlite3_changes(database), 1);
  sqlite3_close(database);
}

class DamagedRecordTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    ASSERT_EQ(RunHvas({"assemble", ProductFile("bushing"), "--record", Whole(), "-q"}).status, 0);
  }

  static void TearDownTestSuite() { folder_.reset(); }

  static std::string Whole() { return (*folder_ / "whole.hvasrec").string(); }

  /** A copy that was changed by some SQL. */
  std::string Damage(const char* sql) {
    const std::string file = (out / "damaged.hvasrec").string();
    fs::copy_file(Whole(), file, fs::copy_options::overwrite_existing);
    Tamper(file, sql);
    return file;
  }

  TemporaryFolder out;

 private:
  static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> DamagedRecordTest::folder_;

TEST_F(DamagedRecordTest, IsNotVerifiedAndWhatIsWrongIsNamed) {
  EXPECT_EQ(RunHvas({"replay", Whole(), "--verify"}).status, 0);
  const std::vector<std::pair<const char*, const char*>> cases{
      {"DELETE FROM chunk WHERE id > (SELECT max(id) - 3 FROM chunk)", "the last 3 of"},
      {"DELETE FROM chunk", "chunks are missing"},
      {"DELETE FROM event", "events are missing"},
      {"UPDATE meta SET value = '2' WHERE key = 'seed'", "\"seed\" was changed"},
      {"UPDATE meta SET value = 'collision' WHERE key = 'condition'", "\"condition\" was changed"},
      {"DELETE FROM meta WHERE key = 'digest'", "\"digest\" is missing"},
      {"UPDATE meta SET value = 'abc' WHERE key = 'digest'", "\"digest\" was changed"},
  };
  for (const auto& [sql, named] : cases) {
    const Ran ran = RunHvas({"replay", Damage(sql), "--verify"});
    EXPECT_EQ(ran.status, 2) << sql;
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, named, ran.err);
    EXPECT_EQ(ran.out.find("of the session is the recorded one"), std::string::npos) << sql;
  }
  const json replayed =
      testing::RunHvasJson({"replay", Damage("DELETE FROM event"), "--verify"}, 2);
  EXPECT_FALSE(replayed["exact"].get<bool>());
  EXPECT_NE(replayed["damage"].get<std::string>().find("event"), std::string::npos);
}

TEST_F(DamagedRecordTest, IsReportedAndExportedWithAWarning) {
  const std::string record = Damage("DELETE FROM chunk WHERE id = 5");
  const std::string page = (out / "page.html").string();
  const Ran report = RunHvas({"report", record, "-o", page});
  EXPECT_EQ(report.status, 2);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "chunk 5", report.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "This record is damaged", ReadText(page));
  for (const char* name : {"x.csv", "x.json", "x.h5", "x.mcap", "x.glb"}) {
    const Ran ran = RunHvas({"export", record, "-o", (out / name).string()});
    EXPECT_EQ(ran.status, 2) << name;
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "chunk 5", ran.err);
    EXPECT_TRUE(fs::exists(out / name));
  }
}

TEST_F(DamagedRecordTest, IsReportedUpToAChunkThatCannotBeRead) {
  const std::string record =
      Damage("UPDATE chunk SET ticks = zeroblob(length(ticks)) WHERE id = 20");
  const std::string page = (out / "page.html").string();
  EXPECT_EQ(RunHvas({"report", record, "-o", page}).status, 2);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "Chunk 20", ReadText(page));
}

TEST_F(DamagedRecordTest, WithoutItsProductIsAnErrorWhereTheProductIsNeeded) {
  const std::string record =
      Damage("UPDATE attachment SET bytes = zeroblob(length(bytes)) WHERE name = 'product'");
  for (const char* name : {"x.glb", "x.html"}) {
    const std::string command = std::string(name).ends_with("glb") ? "export" : "report";
    const Ran ran = RunHvas({command, record, "-o", (out / name).string()});
    EXPECT_EQ(ran.status, 1) << name;
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, "Attachment \"product\"", ran.err);
    EXPECT_FALSE(fs::exists(out / name));
  }
}

TEST_F(DamagedRecordTest, IsNeverReplacedUnasked) {
  const std::string record = Damage("DELETE FROM chunk WHERE id = 5");
  const std::string before = ReadText(record);
  const std::vector<std::string> again{
      "assemble", ProductFile("bushing"), "--record", record, "--limit", "1", "-q"};
  const Ran refused = RunHvas(again);
  EXPECT_EQ(refused.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "--force", refused.err);
  EXPECT_EQ(ReadText(record), before);
  std::vector<std::string> forced = again;
  forced.emplace_back("--force");
  EXPECT_EQ(RunHvas(forced).status, 2) << "one second is not enough for all parts";
  EXPECT_TRUE(record::Reader::Open(record)->Verify().has_value());
}

/** No file may grow beyond a size: as a disk that is full. */
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
  }

  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  sighandler_t handler_{};
};

TEST_F(DamagedRecordTest, OnAFullDiskTheTableIsPrintedAndWhatFitIsARecord) {
  const std::string record = (out / "full.hvasrec").string();
  Ran ran;
  {
    const FileSizeLimit limit(fs::file_size(Whole()) / 2);
    ran = RunHvas({"assemble", ProductFile("bushing"), "--record", record, "-q"});
  }
  EXPECT_EQ(ran.status, 1);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "the assembly continues", ran.err);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "shaft", ran.out);
  auto reader = record::Reader::Open(record);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->Verify().has_value());
  EXPECT_FALSE(reader->is_complete());
}

TEST_F(DamagedRecordTest, ExportsToAFullDiskAreErrorsAndLeaveNothing) {
  for (const char* name : {"x.csv", "x.json", "x.h5", "x.mcap", "x.glb"}) {
    Ran ran;
    {
      const FileSizeLimit limit(1000);
      ran = RunHvas({"export", Whole(), "-o", (out / name).string()});
    }
    EXPECT_EQ(ran.status, 1) << name << ": " << ran.err;
    EXPECT_NE(ran.err.find("hvas: "), std::string::npos) << name;
  }
  EXPECT_TRUE(fs::is_empty(out.path()));
}

}  // namespace
}  // namespace hvas::app
