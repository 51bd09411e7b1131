// What is left of a session whose process was killed: bench/record_kills does two hundred.

#include <fmt/format.h>

#include "base/test/temporary_folder.h"
#include "record/session_file.h"
#include "record/write_claim.h"
#include "session/recorded_model.h"
#include "session/test/killed_session.h"
#include "session/test/recorded_session.h"

namespace hvas::session {
namespace {

class KilledSession : public ::testing::TestWithParam<bool> {};

TEST_P(KilledSession, LosesAtMostOneSecondAndRunsAgainBitForBitUpToThere) {
  const auto model = simulation::testing::PegInBlockModel();
  for (const int after_ms : {30, 700, 1900}) {
    SCOPED_TRACE(after_ms);
    const hvas::testing::TemporaryFolder folder;
    const auto file = folder / "session";
    const std::int64_t ran =
        testing::RecordAndKill(model, file, GetParam(), std::chrono::milliseconds(after_ms));
    ASSERT_GE(ran, 0) << "it ended by itself";
    auto reader = record::Reader::Open(file);
    if (!reader && ran == 0) {  // before there was a record
      EXPECT_NE(reader.error().message.find("ended before its first second"), std::string::npos);
      continue;
    }
    ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
    const auto verified = reader->Verify();
    ASSERT_TRUE(verified.has_value()) << verified.error().ToString();
    EXPECT_GE(reader->tick_count(), ran - 1000);
    EXPECT_LE(reader->tick_count(), ran + 1);
    if (reader->tick_count() > 0) {
      const auto report = testing::ReplayFile(file);
      ASSERT_TRUE(report.has_value()) << report.error().ToString();
      EXPECT_TRUE(report->is_exact());
      EXPECT_EQ(report->ticks, reader->tick_count());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Times, KilledSession, ::testing::Bool(), [](const auto& mode) {
  return mode.param ? "InRealTime" : "InVirtualTime";
});

/** What opening a record and its product says; empty where there is nothing to say. */
std::string FindComplaint(const std::filesystem::path& file) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return reader.error().message;
  }
  const auto product = LoadProduct(&*reader);
  return product ? std::string() : product.error().message;
}

/** Runs in a process of its own, which is killed as soon as it has done this.
 @pre this process has one thread. */
template <typename Write>
void WriteAndBeKilled(const Write& write) {
  const pid_t child = ::fork();
  if (child == 0) {
    write();
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
}

constexpr const char* kEarly = "the recording ended before its first second";

TEST(SessionKilledEarly, SaysSoInEachStateThatItsWriterPasses) {
  const auto model = simulation::testing::PegInBlockModel();
  const hvas::testing::TemporaryFolder folder;
  const auto execute = [](const std::filesystem::path& file, const std::string& sql) {
    WriteAndBeKilled([&] {
      auto database = record::Database::Open(file, record::Database::Mode::kCreate);
      (void)database->Execute(sql);
    });
  };
  const std::string mode = "PRAGMA page_size=16384; PRAGMA journal_mode=WAL;";
  folder.Write("claimed", "");
  execute(folder / "opened", mode);
  execute(folder / "marked",
          mode + fmt::format("PRAGMA application_id={};", record::kApplicationId));
  WriteAndBeKilled([&] {
    const auto recorder = record::Recorder::Create({.path = folder / "begun"}, {});
    ::kill(::getpid(), SIGKILL);  // It would finish the record at its end.
  });
  for (const char* state : {"claimed", "opened", "marked", "begun"}) {
    EXPECT_EQ(FindComplaint(folder / state).substr(0, std::string(kEarly).size()), kEarly) << state;
    EXPECT_TRUE(record::CheckTarget(folder / state, true)) << state << " can be replaced";
  }
}

TEST(SessionKilledEarly, HasItsProductOrSaysWhyItHasNone) {
  const auto model = simulation::testing::PegInBlockModel();
  constexpr int kLongest_ms = 5000;  // A busy machine takes longer to come to the product.
  int with_product = 0;
  for (int after_ms = 0; after_ms < 100 || (with_product == 0 && after_ms < kLongest_ms);
       after_ms += 1 + after_ms / 4) {
    const hvas::testing::TemporaryFolder folder;
    ASSERT_GE(testing::RecordAndKill(model, folder / "session", true,
                                     std::chrono::milliseconds(after_ms)),
              0);
    if (!std::filesystem::exists(folder / "session")) {
      continue;
    }
    const std::string complaint = FindComplaint(folder / "session");
    with_product += complaint.empty() ? 1 : 0;
    EXPECT_TRUE(complaint.empty() || complaint.starts_with(kEarly)) << complaint;
  }
  EXPECT_GT(with_product, 0);
}

}  // namespace
}  // namespace hvas::session
