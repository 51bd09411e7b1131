#include "session/replay.h"

#include <atomic>
#include <thread>

#include "base/test/temporary_folder.h"
#include "person/test/waypoints.h"
#include "session/command_json.h"
#include "session/test/recorded_session.h"
#include "spatial/rounding.h"

namespace hvas::session {
namespace {

using simulation::testing::PegInBlockModel;
using testing::MakeRecorder;
using testing::ReplayFile;
using testing::Stretch;

class ReplayTest : public ::testing::Test {
 protected:
  hvas::testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "session";
};

void ExpectExact(const Result<ReplayReport>& report) {
  ASSERT_TRUE(report.has_value()) << report.error().ToString();
  EXPECT_EQ(report->different_ticks, 0) << report->first->field << " at " << report->first->t_ns;
  EXPECT_EQ(report->unreachable_ticks, 0);
  EXPECT_TRUE(report->is_exact());
}

TEST_F(ReplayTest, SessionInVirtualTimeComesOutBitForBit) {  // N7
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file_);
  SessionRecorder sink(recorder.get(), *model);
  Stretch stretch(model, 1, &sink);
  sink.Begin(stretch.simulation.get());
  const auto ran = RunLockstep(stretch.MakeExecution(60));
  ASSERT_TRUE(recorder->Finish().has_value());
  const auto report = ReplayFile(file_);
  ExpectExact(report);
  EXPECT_EQ(report->stretches, 1);
  EXPECT_EQ(report->ticks, static_cast<std::int64_t>(ran.ticks));
  EXPECT_EQ(report->session_ns, ran.session_ns);
  ASSERT_EQ(report->parts.size(), 1u) << "the base was not in the hand";
  EXPECT_TRUE(report->parts[0].replayed.is_seated);
  EXPECT_GT(report->parts[0].replayed.peak_felt, 0.5);
  EXPECT_EQ(report->parts[0].replayed.peak_felt, report->parts[0].recorded.peak_felt);
}

/** Copies what a replay needs of a record, with ticks between the steps as before schema 6: each
 result of a tick is off by less than half a step. */
void CopyBetweenSteps(const std::filesystem::path& from, const std::filesystem::path& to) {
  auto reader = record::Reader::Open(from);
  ASSERT_TRUE(reader.has_value());
  const auto recorder = MakeRecorder(to);
  const std::vector<std::string> names = reader->ListAttachments().value();
  for (const std::string& name : names) {
    recorder->AddAttachment({name, reader->ReadAttachment(name).value()});
  }
  const std::vector<record::Command> commands = reader->ReadCommands().value();
  for (const record::Command& command : commands) {
    recorder->AddCommand(command);
  }
  const auto done = reader->ForEachTick({}, [&](record::TickRecord tick) {
    const auto off = [](double step) -> Vec3 { return 0.4 * step * Vec3(1, -1, 1); };
    tick.X_WD = {tick.X_WD.q(), tick.X_WD.p() + off(spatial::kLengthStep)};
    tick.F_felt_W.f += off(spatial::kForceStep);
    tick.F_true_W.t += off(spatial::kTorqueStep);
    return recorder->AddTick(tick);
  });
  ASSERT_TRUE(done.has_value());
  ASSERT_TRUE(recorder->Finish().has_value());
}

TEST_F(ReplayTest, RecordOfBeforeTheStepsComesOutBitForBit) {
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file_);
  SessionRecorder sink(recorder.get(), *model);
  Stretch stretch(model, 1, &sink);
  sink.Begin(stretch.simulation.get());
  (void)RunLockstep(stretch.MakeExecution(60));
  ASSERT_TRUE(recorder->Finish().has_value());
  const std::filesystem::path older = folder_ / "older";
  CopyBetweenSteps(file_, older);
  ExpectExact(ReplayFile(older));
}

/** Puts the peg into the carrier on the table, carries both and lets them fall; records it. */
std::vector<simulation::PartState> RecordTableSubassembly(const std::filesystem::path& file) {
  const auto& model = simulation::testing::PegInCarrierInCupModel();
  const auto recorder = MakeRecorder(file);
  SessionRecorder sink(recorder.get(), *model);
  simulation::Simulation simulation(model, haptics::TickOptions());
  simulation.physics().AllowJoining(0);
  sink.Begin(&simulation);
  simulation::AssemblyRun run(&simulation, simulation::TaskOperators{}, &sink);
  constexpr std::size_t kCarrier = 1;
  constexpr std::size_t kPeg = 2;
  const auto& carrier = model->bodies[kCarrier];
  const auto& peg = model->bodies[kPeg];
  const Vec3 p_peg = peg.X_WB_start * peg.mass.p_BoBcm_B;
  const Vec3 p_goal =
      carrier.X_WB_start * carrier.X_WB_goal.Inverse() * peg.X_WB_goal * peg.mass.p_BoBcm_B;
  const double height = p_goal.z() + 60e-3;
  auto way = person::testing::CarryOver(p_peg, p_goal, height);
  const Vec3 p_fall = p_goal + Vec3(-0.12, 0, 30e-3);
  for (const auto& point : person::testing::CarryOver(p_goal, p_fall, height)) {
    way.push_back(point);
  }
  person::testing::WaypointHand hand(way);
  simulation::Execution execution = run.MakeExecution(&hand, 60);
  execution.is_done = [&hand] { return hand.is_done(); };
  (void)RunLockstep(execution);
  EXPECT_TRUE(recorder->Finish().has_value());
  return simulation.physics().parts();
}

TEST_F(ReplayTest, X1SubassemblyOfTheTableComesOutBitForBit) {
  const std::vector<simulation::PartState> parts = RecordTableSubassembly(file_);
  EXPECT_EQ(parts[2].leader, product::OccurrenceId(1));
  EXPECT_EQ(parts[1].leader, product::OccurrenceId(1));
  const auto report = ReplayFile(file_);
  ExpectExact(report);
  ASSERT_EQ(report->parts.size(), 2u) << "the peg was held, then the carrier with it";
}

TEST_F(ReplayTest, SessionOfBothHandsInRealTimeComesOutBitForBit) {
  // Physics on a thread of its own, late when it likes; forces stopped for a while by another one.
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file_, true);
  SessionRecorder sink(recorder.get(), *model);
  Stretch stretch(model, 2, &sink);
  sink.Begin(stretch.simulation.get());
  std::atomic<bool> is_done{false};
  std::thread somebody([&] {
    for (bool stops = true; !is_done; stops = !stops) {
      stretch.simulation->StopForces(stops);
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
    }
  });
  simulation::FlightRecorder flight(1000, 2);
  simulation::Execution execution = stretch.MakeExecution(3);
  execution.flight = &flight;
  const auto ran = RunRealtime(execution);
  is_done = true;
  somebody.join();
  ASSERT_TRUE(recorder->Finish().has_value());
  ASSERT_EQ(recorder->dropped_ticks(), 0u);  // the ring holds more than this run has
  const auto report = ReplayFile(file_);
  ExpectExact(report);
  EXPECT_EQ(report->ticks, 2 * static_cast<std::int64_t>(ran.ticks));
  EXPECT_FALSE(report->parts.empty());
}

/** Three runs that follow one another, each from where the parts were then; the first one ends with
 the peg in the hand, half in its bore. */
std::int64_t RecordStretches(const std::filesystem::path& file) {
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file);
  SessionRecorder sink(recorder.get(), *model);
  std::int64_t ticks = 0;
  std::vector<simulation::PartState> parts;
  for (const std::size_t hands : {1, 2, 1}) {
    haptics::TickOptions options;
    options.condition = ticks == 0 ? haptics::Condition::kHybrid : haptics::Condition::kConstraint;
    Stretch stretch(model, hands, &sink, options);
    if (!parts.empty()) {
      stretch.simulation->Restore(parts);
      stretch.run.Resume(1);
    }
    sink.Begin(stretch.simulation.get());
    const auto ran = RunLockstep(stretch.MakeExecution(3));
    ticks += static_cast<std::int64_t>(ran.ticks * hands);
    parts = stretch.simulation->physics().parts();
  }
  EXPECT_EQ(sink.t_ns(), recorder->Finish().has_value() ? sink.t_ns() : 0);
  return ticks;
}

TEST_F(ReplayTest, StretchesOfOneSessionComeOutBitForBit) {
  const std::int64_t ticks = RecordStretches(file_);
  const auto report = ReplayFile(file_);
  ExpectExact(report);
  EXPECT_EQ(report->stretches, 3);
  EXPECT_EQ(report->ticks, ticks);
  const auto all = record::Reader::Open(file_)->ReadTicks({});
  for (std::size_t i = 1; i < all->size(); ++i) {
    const std::int64_t step_ns = (*all)[i].t_ns - (*all)[i - 1].t_ns;
    ASSERT_TRUE(step_ns == 1'000'000 || (step_ns == 0 && (*all)[i].hand == 1))
        << "session time goes on";
  }
}

/** Lets a session go through, but for one tick. */
class Loser final : public simulation::Sink {
 public:
  Loser(SessionRecorder* sink, std::int64_t lost_ns) : sink_(sink), lost_ns_(lost_ns) {}

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override {
    if (device.t_ns != lost_ns_) {
      sink_->OnTick(hand, device, out);
    }
  }

  void OnEvent(const simulation::SimulationEvent& event) override { sink_->OnEvent(event); }

 private:
  SessionRecorder* sink_;
  std::int64_t lost_ns_;
};

TEST_F(ReplayTest, GoesAsFarAsNoTickIsMissingAndOnWithTheNextStretch) {
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file_);
  SessionRecorder sink(recorder.get(), *model);
  Loser loser(&sink, 700'000'000);
  for (int i = 0; i < 2; ++i) {
    Stretch stretch(model, 1, i == 0 ? static_cast<simulation::Sink*>(&loser) : &sink);
    sink.Begin(stretch.simulation.get());
    (void)RunLockstep(stretch.MakeExecution(1));
  }
  ASSERT_TRUE(recorder->Finish().has_value());
  const auto report = ReplayFile(file_);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->ticks, 700 + 1000);
  EXPECT_EQ(report->different_ticks, 0);
  EXPECT_EQ(report->unreachable_ticks, 299);
  EXPECT_FALSE(report->is_exact());
}

TEST_F(ReplayTest, X14OtherParametersComeOutOtherwise) {  // N4
  const auto& model = PegInBlockModel();
  const auto recorder = MakeRecorder(file_);
  SessionRecorder sink(recorder.get(), *model);
  Stretch stretch(model, 1, &sink);
  sink.Begin(stretch.simulation.get());
  (void)RunLockstep(stretch.MakeExecution(60));
  ASSERT_TRUE(recorder->Finish().has_value());
  ReplayOptions options;
  options.condition = haptics::Condition::kCollision;
  const auto alone = ReplayFile(file_, options);
  ASSERT_TRUE(alone.has_value());
  EXPECT_GT(alone->different_ticks, 0);
  EXPECT_GT(alone->largest_felt_difference, 0.01);
  ASSERT_TRUE(alone->first.has_value());
  EXPECT_FALSE(alone->first->field.empty());
  EXPECT_TRUE(alone->parts[0].recorded.is_seated);
  EXPECT_FALSE(alone->parts[0].replayed.is_seated) << "without mates nothing finds its seat";
  options = {};
  options.condition = haptics::Condition::kHybrid;  // as it was
  ExpectExact(ReplayFile(file_, options));
}

TEST_F(ReplayTest, OlderRecordsAreRefusedWithTheirLayout) {
  for (const char* name : {"session_schema_1.sqlite", "session_schema_2.sqlite"}) {
    const auto path = std::filesystem::path(HVAS_SOURCE_DIR) / "src/record/test" / name;
    auto reader = record::Reader::Open(path);
    ASSERT_TRUE(reader.has_value());
    Diagnostics diagnostics;
    const auto model = LoadModel(&*reader, {}, &diagnostics);
    ASSERT_FALSE(model.has_value());
    EXPECT_EQ(model.error().code, ErrorCode::kUnsupported);
    const auto report = Replay(&*reader, PegInBlockModel(), {});
    ASSERT_FALSE(report.has_value());
    EXPECT_EQ(report.error().code, ErrorCode::kUnsupported);
    EXPECT_NE(report.error().message.find(std::to_string(reader->schema())), std::string::npos);
  }
}

TEST_F(ReplayTest, MissingCommandIsNamed) {
  const auto recorder = MakeRecorder(file_);
  const auto& model = PegInBlockModel();
  AttachModel(*model, recorder.get());
  simulation::Simulation simulation(model, haptics::TickOptions());
  recorder->AddCommand({0, 0, kBeginKind,
                        MakeBeginningJson({{simulation.options()}, simulation.physics().parts()})});
  recorder->AddTick(MakeTickRecord(0, {}, {}, 1));
  ASSERT_TRUE(recorder->Finish().has_value());
  const auto report = ReplayFile(file_);
  ASSERT_FALSE(report.has_value());
  EXPECT_EQ(report.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(report.error().message.find("command 1"), std::string::npos);
  EXPECT_EQ(report.error().where, file_.string());
}

/** All paths to values that are no objects or arrays. */
void ListLeaves(const Json& json, const Json::json_pointer& at,
                std::vector<Json::json_pointer>* leaves) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      ListLeaves(value, at / key, leaves);
    }
  } else if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      ListLeaves(json[i], at / i, leaves);
    }
  } else {
    leaves->push_back(at);
  }
}

/** Sums up to what a forger makes: every hash is right, and one value of one command is not. */
void Forge(const std::filesystem::path& from, const std::filesystem::path& to,
           const std::vector<record::Command>& commands) {
  auto reader = record::Reader::Open(from);
  const auto recorder = MakeRecorder(to);
  const std::vector<std::string> names = reader->ListAttachments().value();
  for (const std::string& name : names) {
    recorder->AddAttachment({name, reader->ReadAttachment(name).value()});
  }
  for (const record::Command& command : commands) {
    recorder->AddCommand(command);
  }
  int ticks = 0;
  ASSERT_TRUE(reader->ForEachTick(
      {}, [&](const record::TickRecord& tick) { return recorder->AddTick(tick) && ++ticks < 50; }));
  ASSERT_TRUE(recorder->Finish().has_value());
}

TEST_F(ReplayTest, NoValueOfACommandEndsTheProgram) {
  RecordStretches(file_);
  const auto commands = record::Reader::Open(file_)->ReadCommands().value();
  ASSERT_GE(commands.size(), 2u);
  const std::vector<Json> values{
      nullptr, "x", "nan", "inf", -1, 1e308, 0, 18446744073709551615ull, Json::array()};
  auto reader = record::Reader::Open(file_);
  Diagnostics diagnostics;
  const auto model = LoadModel(&*reader, simulation::testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value());
  int refused = 0;
  int tried = 0;
  for (const std::size_t which : {0, 1}) {
    const Json sound = Json::parse(commands[which].json);
    std::vector<Json::json_pointer> leaves;
    ListLeaves(sound, Json::json_pointer(), &leaves);
    for (const Json::json_pointer& leaf : leaves) {
      auto forged = commands;
      Json json = sound;
      json[leaf] = values[static_cast<std::size_t>(tried) % values.size()];
      forged[which].json = json.dump();
      SCOPED_TRACE(leaf.to_string() + " = " + json[leaf].dump());
      const auto copy = folder_ / std::to_string(++tried);
      Forge(file_, copy, forged);
      auto record = record::Reader::Open(copy);
      ASSERT_TRUE(record.has_value());
      const auto report = Replay(&*record, *model, {});
      refused += report ? 0 : 1;
    }
  }
  EXPECT_GT(tried, 50);
  EXPECT_GT(refused, tried / 4);
}

}  // namespace
}  // namespace hvas::session
