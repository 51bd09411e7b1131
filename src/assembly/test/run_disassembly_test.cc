#include "assembly/run_disassembly.h"

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/replay.h"
#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using simulation::testing::PegInBlockModel;

TEST(RunDisassemblyTest, X16RecordOfATakenPartRunsAgainBitForBit) {
  const hvas::testing::TemporaryFolder folder;
  const auto plan = PlanDisassembly(*PegInBlockModel(), "peg");
  ASSERT_TRUE(plan.has_value()) << plan.error().ToString();
  RunOptions options;
  options.record = folder / "peg.hvasrec";
  const auto outcome = RunDisassembly(PegInBlockModel(), *plan, options);
  ASSERT_TRUE(outcome.has_value()) << outcome.error().ToString();
  EXPECT_TRUE(outcome->is_complete());
  ASSERT_EQ(outcome->run.parts.size(), 1u);
  EXPECT_FALSE(outcome->run.parts[0].is_seated);
  auto reader = record::Reader::Open(options.record);
  ASSERT_TRUE(reader.has_value());
  const auto replayed = session::Replay(&*reader, PegInBlockModel(), {});
  ASSERT_TRUE(replayed.has_value()) << replayed.error().ToString();
  EXPECT_TRUE(replayed->is_exact());
  EXPECT_EQ(static_cast<std::uint64_t>(replayed->ticks), outcome->run.execution.ticks);
}

TEST(RunDisassemblyTest, X16RefusesTheBaseAndWhatIsNotThere) {
  const auto base = PlanDisassembly(*PegInBlockModel(), "block");
  ASSERT_FALSE(base.has_value());
  EXPECT_EQ(base.error().code, ErrorCode::kInvalid);
  const auto unknown = PlanDisassembly(*PegInBlockModel(), "screw");
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::kNotFound);
}

TEST(RunDisassemblyTest, X16StoppedRunListsThePartsThatHadNoTurn) {
  const auto plan = PlanDisassembly(*PegInBlockModel(), "");
  ASSERT_TRUE(plan.has_value());
  RunOptions options;
  options.limit_s = 0.5;
  const auto outcome = RunDisassembly(PegInBlockModel(), *plan, options);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_FALSE(outcome->is_complete());
  ASSERT_EQ(outcome->run.parts.size(), 1u);
  EXPECT_NE(outcome->run.parts[0].reason, "");
  options.devices = {"", ""};
  EXPECT_FALSE(RunDisassembly(PegInBlockModel(), *plan, options).has_value());
}

}  // namespace
}  // namespace hvas::assembly
