// What is left of a session whose process was killed: bench/record_kills does two hundred.

#include "base/test/temporary_folder.h"
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
    if (!reader && ran == 0) {
      continue;  // before there was a record
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

}  // namespace
}  // namespace hvas::session
