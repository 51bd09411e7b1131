#include "app/session_recorder.h"

#include <array>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/load_product.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"
#include "device/opened_device.h"
#include "record/reader.h"
#include "simulation/assembly_run.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"
#include "simulation/tick_log.h"

namespace hvas::app {
namespace {

using record::TickRecord;
using simulation::Simulation;
using simulation::TickLog;

std::shared_ptr<const simulation::Model> Bushing() {
  LoadOptions load;
  load.file = testing::ProductFile("bushing");
  load.is_quiet = true;
  Diagnostics diagnostics;
  auto product = LoadProduct(load, &diagnostics);
  EXPECT_TRUE(product.has_value());
  return *simulation::Compile(std::make_shared<product::Product>(std::move(*product)), {},
                              &diagnostics);
}

/** A simulated person with an emulated device in the hand. */
struct Hand {
  Hand(const simulation::Model& model, const char* address, std::uint64_t seed)
      : opened(*device::OpenAnyDevice(address, false)),
        options(simulation::MakeTickOptions(opened.device->info(), model, {})),
        person(simulation::MakePersonOptions(options), seed, simulation::StartOfHand(model)),
        at_device(&person, opened.emulator.get(), opened.device.get(), false) {}

  device::OpenedDevice opened;
  haptics::TickOptions options;
  simulation::SimulatedPerson person;
  simulation::PersonAtDevice at_device;
};

/** The log that a file's ticks give, with the commands of the session's own log. */
void FillLog(const std::vector<TickRecord>& ticks, const TickLog& commands, TickLog* log) {
  std::size_t k = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    for (; k < commands.command_count() && commands.command(k).tick <= i; ++k) {
      log->Add(commands.command(k).command);
    }
    const haptics::TickContext context = MakeTickContext(ticks[i]);
    TickLog::Tick tick;
    tick.device = MakeDeviceState(ticks[i]);
    tick.model_age_ns = context.model_age_ns;
    tick.is_stopped = context.is_stopped;
    tick.effort_level = static_cast<std::uint8_t>(context.effort_level);
    tick.hand = ticks[i].hand;
    log->Add(tick);
  }
}

/** Everything of a sample, to be compared. */
auto Tie(const device::DeviceState& s) {
  return std::tie(s.t_ns, s.sample_ns, s.is_gripping, s.is_valid, s.is_clutching, s.buttons,
                  s.condition, s.vendor_code);
}

TEST(SessionRecorderTest, EveryTickOfBothHandsRunsAgainFromTheFile) {  // X4, N7
  const hvas::testing::TemporaryFolder folder;
  const auto file = folder / "session";
  const auto model = Bushing();
  Hand left(*model, "emulated:openhaptics:touch_x", 1);
  Hand right(*model, "emulated:haply", 2);
  Simulation simulation(model, left.options, right.options);
  TickLog log(100'000);
  simulation.KeepLog(&log);
  record::RecorderOptions options;
  options.path = file;
  const auto recorder = record::Recorder::Create(options, {});
  ASSERT_TRUE(recorder.has_value());
  SessionRecorder sink(recorder->get());
  simulation::AssemblyRun run(&simulation, simulation::Persons{&left.person, &right.person}, &sink);
  simulation::Execution execution = run.MakeExecution(&left.at_device, 20, &right.at_device);
  execution.log = &log;
  int steps = 0;
  execution.advance = [&] {  // somebody stops the forces once, for a tenth of a second
    run.Advance();
    ++steps;
    simulation.StopForces(steps > 200 && steps <= 210);
  };
  execution.is_physics_late = [](std::int64_t t_ns) { return t_ns / 50'000'000 == 30; };
  const simulation::ExecutionReport report = RunLockstep(execution);
  ASSERT_TRUE((*recorder)->Finish().has_value());

  const auto ticks = record::Reader::Open(file)->ReadTicks({});
  ASSERT_TRUE(ticks.has_value());
  ASSERT_EQ(ticks->size(), 2 * report.ticks);
  ASSERT_EQ(log.tick_count(), ticks->size());
  TickLog from_file(ticks->size());
  FillLog(*ticks, log, &from_file);
  Simulation again(model, left.options, right.options);
  int stopped = 0;
  std::array<int, 2> with_part{};
  for (std::size_t i = 0; i < ticks->size(); ++i) {
    const TickRecord& tick = (*ticks)[i];
    ASSERT_EQ(tick.hand, i % 2);
    ASSERT_EQ(Tie(from_file.tick(i).device), Tie(log.tick(i).device)) << i;
    stopped += from_file.tick(i).is_stopped ? 1 : 0;
    with_part.at(tick.hand) += tick.held != record::kNoOccurrence ? 1 : 0;
    const haptics::TickOutput out = again.ReplayTick(from_file, i);
    ASSERT_EQ(out.F_H_D.f, log.tick(i).F_H_D.f) << i;
    ASSERT_EQ(out.F_H_D.t, log.tick(i).F_H_D.t) << i;
    ASSERT_EQ(out.F_H_W.f, tick.F_felt_W.f) << i;
    ASSERT_EQ(out.X_WD.p(), tick.X_WD.p()) << i;
    ASSERT_EQ(static_cast<std::uint8_t>(out.state), tick.state) << i;
  }
  EXPECT_GT(stopped, 100);
  EXPECT_GT(with_part[0], 1000);
  EXPECT_GT(with_part[1], 1000);
  EXPECT_GT(ticks->back().sample_ns, 0) << "emulated devices say when";
}

TEST(SessionRecorderTest, KeepsAllOfASample) {
  record::RecorderOptions options;
  const hvas::testing::TemporaryFolder folder;
  options.path = folder / "session";
  const auto recorder = record::Recorder::Create(options, {});
  SessionRecorder sink(recorder->get());
  device::DeviceState device;
  device.t_ns = 5;
  device.sample_ns = 4;
  device.X_DH = spatial::Pose(Vec3(1, 2, 3));
  device.V_DH.w = Vec3(4, 5, 6);
  device.is_gripping = true;
  device.is_valid = false;
  device.is_clutching = true;
  device.buttons = 6;
  device.grip = 0.25;
  device.condition = device::Condition::kStale;
  device.vendor_code = -7;
  haptics::TickOutput out;
  out.context.model_age_ns = 8;
  out.context.is_stopped = true;
  out.context.effort_level = 2;
  sink.OnTick(1, device, out);
  ASSERT_TRUE((*recorder)->Finish().has_value());
  const auto ticks = record::Reader::Open(options.path)->ReadTicks({});
  ASSERT_EQ(ticks->size(), 1u);
  const TickRecord& tick = ticks->front();
  const device::DeviceState back = MakeDeviceState(tick);
  EXPECT_EQ(Tie(back), Tie(device));
  EXPECT_EQ(back.X_DH.p(), device.X_DH.p());
  EXPECT_EQ(back.V_DH.w, device.V_DH.w);
  EXPECT_EQ(back.grip, device.grip);
  EXPECT_EQ(tick.hand, 1);
  const haptics::TickContext context = MakeTickContext(tick);
  EXPECT_EQ(context.model_age_ns, 8);
  EXPECT_TRUE(context.is_stopped);
  EXPECT_EQ(context.effort_level, 2);
}

}  // namespace
}  // namespace hvas::app
