#include "session/session_recorder.h"

#include <tuple>

#include "base/test/temporary_folder.h"
#include "session/test/recorded_session.h"

namespace hvas::session {
namespace {

using record::TickRecord;
using simulation::testing::PegInBlockModel;
using testing::MakeRecorder;

/** Everything of a sample but its poses, to be compared. */
auto Tie(const device::DeviceState& s) {
  return std::tie(s.t_ns, s.sample_ns, s.is_gripping, s.is_valid, s.is_clutching, s.buttons,
                  s.condition, s.vendor_code, s.client_age_ns);
}

TEST(SessionRecorderTest, KeepsAllOfASample) {
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
  device.client_age_ns = 9;
  haptics::TickOutput out;
  out.context.model_age_ns = 8;
  out.context.is_stopped = true;
  out.context.effort_level = 2;
  const TickRecord tick = MakeTickRecord(1, device, out, 3);
  const device::DeviceState back = MakeDeviceState(tick);
  EXPECT_EQ(Tie(back), Tie(device));
  EXPECT_EQ(back.X_DH.p(), device.X_DH.p());
  EXPECT_EQ(back.V_DH.w, device.V_DH.w);
  EXPECT_EQ(back.grip, device.grip);
  EXPECT_EQ(tick.hand, 1);
  EXPECT_EQ(tick.commands, 3u);
  const haptics::TickContext context = MakeTickContext(tick);
  EXPECT_EQ(context.model_age_ns, 8);
  EXPECT_TRUE(context.is_stopped);
  EXPECT_EQ(context.effort_level, 2);
  EXPECT_EQ(context.since_write_ns, 0);
}

// N9: a replayed gate starts anew where the recorded one did.
TEST(SessionRecorderTest, KeepsThatTheProgramStoodStill) {
  haptics::TickOutput out;
  out.gate_actions = haptics::kGateStalled | haptics::kGateSoftStart;
  const haptics::TickContext context = MakeTickContext(MakeTickRecord(0, {}, out, 0));
  EXPECT_TRUE(haptics::SafetyGate::IsStall(context.since_write_ns));
}

TEST(SessionRecorderTest, TimesOfASecondStretchGoOn) {
  const hvas::testing::TemporaryFolder folder;
  const auto file = folder / "session";
  const auto recorder = MakeRecorder(file);
  const auto& model = PegInBlockModel();
  SessionRecorder sink(recorder.get(), *model);
  for (int i = 0; i < 2; ++i) {
    simulation::Simulation simulation(model, haptics::TickOptions());
    sink.Begin(&simulation);
    simulation.physics().PlaceInFixture(product::OccurrenceId(0));
    device::DeviceState device;
    for (device.t_ns = 0; device.t_ns < 3'000'000; device.t_ns += 1'000'000) {
      sink.OnTick(0, device, simulation.haptics().Tick(0, device));
    }
    simulation::SimulationEvent event;
    event.t_ns = 1'000'000;
    sink.OnEvent(event);
    simulation::FlightTick flight{};
    flight.device.t_ns = 2'000'000;
    sink.OnFlight({flight});
  }
  EXPECT_EQ(sink.t_ns(), 6'000'000);
  ASSERT_TRUE(recorder->Finish().has_value());
  auto reader = record::Reader::Open(file);
  const auto commands = reader->ReadCommands();
  ASSERT_EQ(commands->size(), 4u);
  EXPECT_EQ((*commands)[2].kind, "begin");
  EXPECT_EQ((*commands)[2].t_ns, 3'000'000);
  EXPECT_EQ((*commands)[3].kind, "place");
  EXPECT_EQ((*commands)[3].number, 1) << "counted from the stretch's beginning";
  EXPECT_GE((*commands)[3].t_ns, 3'000'000);
  const auto events = reader->ReadEvents();
  EXPECT_EQ((*events)[2].t_ns, 4'000'000);
  EXPECT_EQ((*events)[3].t_ns, 5'000'000);
  EXPECT_NE((*events)[3].json.find("5.0"), std::string::npos) << "[ms] in a flight's table";
  const auto ticks = reader->ReadTicks({});
  ASSERT_EQ(ticks->size(), 6u);
  EXPECT_EQ(ticks->back().t_ns, 5'000'000);
  EXPECT_EQ(ticks->back().commands, 1u);
}

TEST(RecordedModelTest, IsMadeAgainFromTheFileAlone) {
  const hvas::testing::TemporaryFolder folder;
  const auto file = folder / "session";
  simulation::CompileOptions options = simulation::testing::FastOptions();
  options.seed = 77;
  options.pairs = fits::PairChoice::kOnePair;
  Diagnostics diagnostics;
  options.steps = PegInBlockModel()->sequence.steps;
  ASSERT_EQ(options.steps.size(), 2u);
  std::swap(options.steps[0], options.steps[1]);  // as somebody ordered
  const auto compiled = simulation::Compile(PegInBlockModel()->product, options, &diagnostics);
  ASSERT_TRUE(compiled.has_value());
  const simulation::Model* model = compiled->get();
  const auto recorder = MakeRecorder(file);
  AttachModel(*model, recorder.get());
  ASSERT_TRUE(recorder->Finish().has_value());
  auto reader = record::Reader::Open(file);
  const auto back = LoadModel(&*reader, simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(back.has_value()) << back.error().ToString();
  EXPECT_EQ((*back)->seed, 77u);
  EXPECT_EQ((*back)->pairs, fits::PairChoice::kOnePair);
  EXPECT_EQ((*back)->sequence.steps[0].occurrence, model->sequence.steps[0].occurrence);
  EXPECT_EQ((*back)->table_z, model->table_z);
  for (std::size_t i = 0; i < model->bodies.size(); ++i) {
    EXPECT_EQ((*back)->bodies[i].X_WB_start.p(), model->bodies[i].X_WB_start.p());
  }
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 0);
  // Prepared in another way it is told.
  simulation::CompileOptions finer = simulation::testing::FastOptions();
  finer.shape.voxel = 0.7e-3;
  ASSERT_TRUE(LoadModel(&*reader, finer, &diagnostics).has_value());
  ASSERT_EQ(diagnostics.Count(Severity::kWarning), 1);
  EXPECT_EQ(diagnostics.items().back().code, "model-differs");
}

}  // namespace
}  // namespace hvas::session
