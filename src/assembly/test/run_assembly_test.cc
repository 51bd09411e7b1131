#include "assembly/run_assembly.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "assembly/assembly_setup.h"
#include "base/test/temporary_folder.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/replay.h"
#include "session/session_recorder.h"
#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using simulation::testing::PegInBlockModel;

TEST(RunAssemblyTest, GivesTheSameDigestForTheSameOptions) {
  const auto first = RunAssembly(PegInBlockModel(), {});
  const auto again = RunAssembly(PegInBlockModel(), {});
  ASSERT_TRUE(first.has_value()) << first.error().ToString();
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(first->is_complete());
  EXPECT_EQ(first->parts.size(), 2u);
  EXPECT_EQ(first->digest.size(), 32u);
  EXPECT_EQ(first->digest, again->digest);
  EXPECT_EQ(first->execution.ticks, again->execution.ticks);
  EXPECT_TRUE(first->devices.empty());
  RunOptions other;
  other.seed = 2;
  EXPECT_EQ(RunAssembly(PegInBlockModel(), other)->digest, first->digest)
      << "a guided hand has no chance in it";
  other.person = person::PersonKind::kCareful;
  const auto person = RunAssembly(PegInBlockModel(), other);
  other.seed = 3;
  EXPECT_NE(RunAssembly(PegInBlockModel(), other)->digest, person->digest);
}

TEST(RunAssemblyTest, TellsOfEachPartAndEachDevice) {
  RunOptions options;
  options.devices = {"", "emulated:haply"};
  std::vector<DeviceInHand> told;
  std::vector<product::OccurrenceId> parts;
  options.on_begin = [&told](const std::vector<DeviceInHand>& devices) { told = devices; };
  options.on_part = [&parts](const auto& progress, const simulation::PartResult& part) {
    EXPECT_LE(progress.tried, progress.total);
    parts.push_back(part.occurrence);
  };
  const auto outcome = RunAssembly(PegInBlockModel(), options);
  ASSERT_TRUE(outcome.has_value()) << outcome.error().ToString();
  EXPECT_TRUE(outcome->is_complete());
  EXPECT_EQ(outcome->hands, 2u);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].hand, 1u);
  EXPECT_EQ(told[0].address, "emulated:haply");
  EXPECT_TRUE(told[0].is_emulated);
  EXPECT_EQ(outcome->devices.size(), 1u);
  ASSERT_FALSE(parts.empty());
}

TEST(RunAssemblyTest, FiveHandsTakeTurnsAndEachHasASeedAndADeviceOfItsOwn) {
  const hvas::testing::TemporaryFolder folder;
  RunOptions options;
  options.devices = {"", "emulated:haply", "", "", "emulated:haply"};
  options.record = folder / "session.hvasrec";
  std::set<std::size_t> hands;
  options.on_part = [&hands](const auto&, const simulation::PartResult& part) {
    hands.insert(part.hand);
  };
  const auto outcome =
      RunAssembly(simulation::testing::CompileFast(simulation::testing::BlocksOnPlate(5)), options);
  ASSERT_TRUE(outcome.has_value()) << outcome.error().ToString();
  EXPECT_TRUE(outcome->is_complete());
  EXPECT_EQ(outcome->hands, 5u);
  EXPECT_EQ(hands, (std::set<std::size_t>{0, 1, 2, 3, 4}));
  auto reader = record::Reader::Open(options.record);
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ(reader->meta().at("second_device"), "emulated:haply");
  EXPECT_EQ(reader->meta().at("third_device"), "");
  EXPECT_EQ(reader->meta().at("fifth_device"), "emulated:haply");
  std::set<std::uint64_t> seeds;
  for (std::size_t hand = 0; hand < haptics::kMaxHands; ++hand) {
    seeds.insert(person::SeedOfHand(options.seed, hand));
  }
  EXPECT_EQ(seeds.size(), haptics::kMaxHands);
}

TEST(RunAssemblyTest, RefusesADeviceThatIsMissing) {
  RunOptions options;
  options.devices = {"no_such_driver"};
  const auto unknown = RunAssembly(PegInBlockModel(), options);
  ASSERT_FALSE(unknown.has_value());
  EXPECT_EQ(unknown.error().code, ErrorCode::kInvalid);
  options.devices = {"", "emulated:haply:no_such_profile"};
  EXPECT_FALSE(RunAssembly(PegInBlockModel(), options).has_value());
  options.devices = {"haply:127.0.0.1:1"};  // A real one, and nobody answers there.
  EXPECT_FALSE(RunAssembly(PegInBlockModel(), options).has_value());
}

TEST(RunAssemblyTest, RefusesOptionsOutOfRange) {
  RunOptions options;
  options.devices = {};
  EXPECT_EQ(RunAssembly(PegInBlockModel(), options).error().code, ErrorCode::kInvalid);
  options.devices.assign(haptics::kMaxHands + 1, "");
  EXPECT_EQ(RunAssembly(PegInBlockModel(), options).error().code, ErrorCode::kInvalid);
  options = {};
  options.render.rate_hz = 0;
  EXPECT_EQ(RunAssembly(PegInBlockModel(), options).error().code, ErrorCode::kInvalid);
}

TEST(RunAssemblyTest, ListsThePartsThatALimitOrAStopLeftOut) {
  RunOptions options;
  options.limit_s = 0.5;
  const auto limited = RunAssembly(PegInBlockModel(), options);
  ASSERT_TRUE(limited.has_value());
  EXPECT_FALSE(limited->is_complete());
  EXPECT_EQ(limited->parts.size(), 2u);
  EXPECT_EQ(limited->execution.session_ns, 500'000'000);
  std::stop_source stop;
  stop.request_stop();
  options = {};
  options.stop = stop.get_token();
  const auto stopped = RunAssembly(PegInBlockModel(), options);
  ASSERT_TRUE(stopped.has_value());
  EXPECT_LT(stopped->execution.session_ns, 100'000'000);
  ASSERT_EQ(stopped->parts.size(), 2u);
  EXPECT_FALSE(stopped->parts.back().reason.empty());
}

TEST(RunAssemblyTest, RunsByTheClock) {
  RunOptions options;
  options.is_realtime = true;
  options.limit_s = 0.2;
  const auto outcome = RunAssembly(PegInBlockModel(), options);
  ASSERT_TRUE(outcome.has_value()) << outcome.error().ToString();
  EXPECT_GE(outcome->execution.wall_ns, 100'000'000);
  EXPECT_FALSE(outcome->execution.scheduling.empty());
}

TEST(RunAssemblyTest, WritesARecordThatRunsAgain) {
  const hvas::testing::TemporaryFolder folder;
  RunOptions options;
  options.record = folder / "session.hvasrec";
  const auto outcome = RunAssembly(PegInBlockModel(), options);
  ASSERT_TRUE(outcome.has_value()) << outcome.error().ToString();
  EXPECT_FALSE(outcome->record_error.has_value());
  auto reader = record::Reader::Open(options.record);
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ(reader->meta().at("condition"), "hybrid");
  const auto report = session::Replay(&*reader, PegInBlockModel(), {});
  ASSERT_TRUE(report.has_value()) << report.error().ToString();
  EXPECT_TRUE(report->is_exact());
  const auto again = RunAssembly(PegInBlockModel(), options);
  ASSERT_FALSE(again.has_value());  // A finished record stays, unless it may be replaced.
  EXPECT_EQ(again.error().code, ErrorCode::kInvalid);
  options.is_record_replaced = true;
  EXPECT_TRUE(RunAssembly(PegInBlockModel(), options).has_value());
}

TEST(RunAssemblyTest, RefusesARecordWhereThereIsNoFolder) {
  RunOptions options;
  options.record = "/nowhere/session.hvasrec";
  const auto outcome = RunAssembly(PegInBlockModel(), options);
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(outcome.error().code, ErrorCode::kNotFound);
}

TEST(AssemblySetupTest, IsWhatARunIsMadeOf) {
  const auto& model = PegInBlockModel();
  auto recorder = MakeRecorder(*model, {}, {{"condition", "mine"}});
  ASSERT_TRUE(recorder.has_value());
  session::SessionRecorder sink(recorder->get(), *model);
  AssemblySetup setup(model, MakePersonHand(*model, MakePersonTick({}), {}, 1), &sink);
  sink.Begin(&setup.simulation());
  simulation::RunLockstep(setup.MakeExecution(CalcTimeLimit(*model)));
  ASSERT_TRUE((*recorder)->Finish().has_value());
  EXPECT_TRUE(setup.run().is_done());
  RunOptions careful;
  careful.person = person::PersonKind::kCareful;
  EXPECT_EQ((*recorder)->Digest(), RunAssembly(model, careful)->digest);
}

TEST(AssemblySetupTest, LimitsTheTimeByThePartsOfTheModel) {
  EXPECT_GE(CalcTimeLimit(*PegInBlockModel()), 2 * 120);
}

}  // namespace
}  // namespace hvas::assembly
