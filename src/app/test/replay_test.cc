// Recorded sessions run again: with devices in both hands, and by the program itself.

#include "session/replay.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/product/load_product.h"
#include "app/test/run_hvas.h"
#include "assembly/assembly_setup.h"
#include "assembly/prepare_model.h"
#include "base/test/temporary_folder.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "session/session_recorder.h"
#include "simulation/executors.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using record::TickRecord;
using testing::ProductFile;
using testing::RunHvas;
using testing::RunHvasJson;

std::shared_ptr<const simulation::Model> Bushing() {
  LoadOptions load;
  load.file = ProductFile("bushing");
  load.is_quiet = true;
  Diagnostics diagnostics;
  auto product = LoadProduct(load, &diagnostics);
  EXPECT_TRUE(product.has_value());
  return *assembly::PrepareModel(std::move(*product), {}, &diagnostics);
}

/** Twenty seconds of two hands: forces are stopped once for a tenth of a second, physics is late
 once, and each fault that a device can have comes and goes. */
std::uint64_t RecordTwoHands(const std::shared_ptr<const simulation::Model>& model,
                             const std::filesystem::path& file) {
  std::vector<assembly::Hand> hands;
  hands.push_back(*assembly::MakeHand(*model, {"emulated:openhaptics:touch_x", {}, 1, false, {}}));
  hands.push_back(*assembly::MakeHand(*model, {"emulated:haply", {}, 2, false, {}}));
  device::EmulatedDevice& left = hands.front().opened.emulator->device();
  record::RecorderOptions options;
  options.path = file;
  const auto recorder = record::Recorder::Create(options, {});
  EXPECT_TRUE(recorder.has_value());
  session::SessionRecorder sink(recorder->get(), *model);
  assembly::AssemblySetup setup(model, std::move(hands), &sink);
  sink.Begin(&setup.simulation());
  simulation::Execution execution = setup.MakeExecution(20);
  std::size_t steps = 0;
  execution.advance = [&] {
    setup.run().Advance();
    ++steps;
    setup.simulation().StopForces(steps > 200 && steps <= 210);
    const std::size_t number = steps / 200;
    const bool has_fault = steps % 200 < 20 && number > 1 && number - 2 < device::kFaults.size();
    left.SetFault(has_fault ? device::kFaults.at(number - 2) : device::Fault::kNone);
  };
  execution.is_physics_late = [](std::int64_t t_ns) { return t_ns / 50'000'000 == 30; };
  const simulation::ExecutionReport report = RunLockstep(execution);
  EXPECT_TRUE((*recorder)->Finish().has_value());
  return report.ticks;
}

TEST(SessionReplayTest, X4EveryTickOfBothHandsRunsAgainFromTheFile) {  // N6, N7
  const hvas::testing::TemporaryFolder folder;
  const auto file = folder / "session";
  const std::uint64_t periods = RecordTwoHands(Bushing(), file);
  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value());
  Diagnostics diagnostics;
  const auto model = session::LoadModel(&*reader, {}, &diagnostics);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  const auto report = session::Replay(&*reader, *model, {});
  ASSERT_TRUE(report.has_value()) << report.error().ToString();
  EXPECT_EQ(report->ticks, 2 * static_cast<std::int64_t>(periods));
  ASSERT_TRUE(report->is_exact()) << report->first->field << " at " << report->first->t_ns;
  // All of it was in the session.
  int stopped = 0;
  int faulty = 0;
  std::array<int, 2> with_part{};
  ASSERT_TRUE(reader
                  ->ForEachTick({},
                                [&](const TickRecord& tick) {
                                  stopped += session::MakeTickContext(tick).is_stopped ? 1 : 0;
                                  faulty += tick.device_condition != 0 ? 1 : 0;
                                  with_part.at(tick.hand) +=
                                      tick.held != record::kNoOccurrence ? 1 : 0;
                                  return true;
                                })
                  .has_value());
  EXPECT_GT(stopped, 100);
  EXPECT_GT(faulty, 100);
  EXPECT_GT(with_part[0], 1000);
  EXPECT_GT(with_part[1], 1000);
}

class ReplayCommandTest : public ::testing::Test {
 protected:
  void Record(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "assemble", ProductFile("bushing"), "--fit", "all=H7/p6", "--record", file_, "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    (void)RunHvas(arguments);
  }

  hvas::testing::TemporaryFolder folder_;
  const std::string file_ = (folder_ / "press.hvasrec").string();
};

TEST_F(ReplayCommandTest, VerifiesASessionInRealTime) {
  Record({"--realtime", "--limit", "3"});
  const json report = RunHvasJson({"replay", file_, "--verify"});
  EXPECT_EQ(report["exact"], true);
  EXPECT_EQ(report["different_ticks"], 0);
  EXPECT_GT(report["ticks"], 2000);
  const auto text = RunHvas({"replay", file_, "--verify"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("bit for bit"), std::string::npos);
}

TEST_F(ReplayCommandTest, ShowsWhatAnotherForceMapWouldHaveBeen) {  // N4
  Record({});
  const json report = RunHvasJson({"replay", file_, "--force-map", "paper"});
  EXPECT_EQ(report["exact"], false);
  EXPECT_GT(report["largest_felt_difference_n"], 0.1);
  EXPECT_GT(report["first_difference"]["time_s"], 0);
  EXPECT_GT(report["rms_felt_difference_n"], 0.01);
  EXPECT_GT(report["different_ticks"], 100);
  EXPECT_EQ(RunHvas({"replay", file_, "--force-map", "paper", "--verify"}).status, 64)
      << "the two make no sense together";
}

TEST_F(ReplayCommandTest, TellsWhatIsNoRecord) {
  const auto missing = RunHvas({"replay", file_});
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find(file_), std::string::npos);
  std::ofstream(file_) << "not a record";
  const auto wrong = RunHvas({"replay", file_});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("not a session record"), std::string::npos);
  const auto old = RunHvas(
      {"replay", std::string(HVAS_SOURCE_DIR) + "/src/record/test/session_schema_2.sqlite"});
  EXPECT_EQ(old.status, 1);
  EXPECT_NE(old.err.find("older"), std::string::npos);
}

}  // namespace
}  // namespace hvas::app
