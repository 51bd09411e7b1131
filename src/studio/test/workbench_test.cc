#include "studio/workbench.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/test/await_true.h"
#include "device/driver.h"
#include "record/reader.h"
#include "session/replay.h"
#include "studio/frame_codec.h"
#include "studio/test/small_bench.h"

namespace hvas::studio {
namespace {

using hvas::testing::AwaitTrue;
using product::OccurrenceId;
using simulation::Placement;
using spatial::Pose;
using testing::EventLog;

constexpr std::size_t kBlock = 0;
constexpr std::size_t kPeg = 1;
constexpr int kSeated = 5;  // docs/protocol.md

/** A live assembly of a block and a peg, in real time. */
class WorkbenchTest : public ::testing::Test {
 protected:
  WorkbenchTest() : bench_(testing::SmallBench()) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
  }

  void TearDown() override { bench_.Stop(); }

  void OpenPeg() {
    const std::size_t start = log_.size();
    bench_.Open("peg.step", "peg");
    ASSERT_TRUE(log_.Await("scene", start));
    ASSERT_TRUE(AwaitPlacement(0, Placement::kPlaced));  // the base goes into its fixture
  }

  [[nodiscard]] Placement PlacementOf(std::size_t i) const {
    const LiveState state = bench_.state();
    return i < state.parts.size() ? state.parts[i].placement : Placement::kLoose;
  }

  bool AwaitPlacement(std::size_t i, Placement wanted) const {
    return AwaitTrue([&] { return PlacementOf(i) == wanted; });
  }

  std::optional<Json> AwaitPlacementEvent(const std::string& placement, std::size_t start) {
    return log_.Await(
        [&](const Json& event) {
          return event["event"] == "placement" && event["occurrence"] == kPeg &&
                 event["placement"] == placement;
        },
        start);
  }

  /** Takes the peg and waits until it is in the hand. */
  void TakePeg() {
    const std::size_t start = log_.size();
    X_WB_start_ = bench_.state().parts[kPeg].X_WB;
    const auto X_WH = bench_.Take(hand_, OccurrenceId(kPeg));
    ASSERT_TRUE(X_WH) << X_WH.error().ToString();
    X_WH_ = *X_WH;
    X_HB_ = X_WH_.Inverse() * X_WB_start_;
    bench_.Move(hand_, X_WH_, true);  // as a client does that does not wait for the event
    ASSERT_TRUE(log_.Await(
        [&](const Json& event) {
          bench_.Move(hand_, X_WH_, true);
          return event["event"] == "taken" && event["occurrence"] == kPeg;
        },
        start));
  }

  /** Moves the peg straight to a pose, with 100 inputs a second. Ends early when the state is
   reached. */
  void MovePeg(const Pose& X_WB, double seconds, int state = -1) {
    const Pose from = X_WH_;
    const Pose to = X_WB * X_HB_.Inverse();
    const Vec3 turn = spatial::RotationBetween(from.q(), to.q());
    const int inputs = static_cast<int>(100 * seconds);
    const std::size_t start = log_.size();
    for (int i = 1; i <= inputs; ++i) {
      const double part = static_cast<double>(i) / inputs;
      X_WH_ = {spatial::RotationFromVector(Vec3(part * turn)) * from.q(),
               Vec3(from.p() + part * (to.p() - from.p()))};
      bench_.Move(hand_, X_WH_, true);
      if (state >= 0 && AwaitState(state, start, 0.01)) {
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  bool AwaitState(int state, std::size_t start, double seconds) {
    return log_
        .Await(
            [&](const Json& event) { return event["event"] == "state" && event["state"] == state; },
            start, seconds)
        .has_value();
  }

  /** Over the bore, then along its axis to the goal and a little on. */
  void InsertPeg() {
    const std::size_t start = log_.size();
    const Pose X_goal = bench_.scene()->model->bodies[kPeg].X_WB_goal;
    const Vec3 up = X_goal.q() * Vec3::UnitZ();
    const auto above = [&](double height) {
      return Pose(X_goal.q(), Vec3(X_goal.p() + height * up));
    };
    MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, 0.08))), 0.8);
    MovePeg(above(0.08), 1.2);
    MovePeg(above(0.03), 0.6);
    MovePeg(above(-0.001), 2.0, kSeated);
    for (int i = 0; i < 2000 && !AwaitState(kSeated, start, 0.01); ++i) {
      bench_.Move(hand_, X_WH_, true);
    }
    ASSERT_TRUE(AwaitState(kSeated, start, 0)) << DescribeHand();
  }

  /** Where the hand and the part are, for a failure that is not seen again. */
  std::string DescribeHand() {
    const haptics::TickOutput& tick = bench_.frame().frame.ticks.at(hand_);
    const Vec3 lag = tick.X_WT.p() - tick.X_WD.p();
    const Vec3 behind = X_WH_.p() - tick.X_WH.p();
    return fmt::format(
        "{}: depth {:.6f} m, tilt {:.4f} rad, offset {:.6f} m; displayed behind tracked "
        "{:.4f} m, hand behind pointer {:.4f} m; {} contacts, gate {:#x}; {}",
        haptics::ToString(tick.state), tick.axis.depth, tick.axis.tilt, tick.axis.offset,
        lag.norm(), behind.norm(), tick.contact_count, tick.gate_actions,
        bench_.hands()[hand_]["condition"].dump());
  }

  void ReleasePeg() {
    const std::size_t start = log_.size();
    ASSERT_TRUE(bench_.Release(hand_));
    ASSERT_TRUE(log_.Await("dropped", start));
  }

  /** As a page reads them: all bodies first, time that never goes back. */
  static void CheckFrames(const std::string& bytes) {
    std::size_t at = 0;
    std::int64_t last_ns = 0;
    int frames = 0;
    while (at + sizeof(protocol::Header) <= bytes.size()) {
      protocol::Header header;
      std::memcpy(&header, bytes.data() + at, sizeof(header));
      if (frames++ == 0) {
        EXPECT_EQ(header.kind, static_cast<std::uint16_t>(protocol::FrameKind::kPoses));
        EXPECT_EQ(header.count, 2u);
      }
      EXPECT_GE(header.t_ns, last_ns);
      last_ns = header.t_ns;
      ASSERT_GT(header.size, 0u);
      at += header.size;
    }
    EXPECT_EQ(at, bytes.size());
    EXPECT_GT(frames, 200);
    EXPECT_GT(last_ns, 4'000'000'000);
  }

  /** Waits until a hand has this device. */
  bool AwaitDevice(std::size_t hand, const std::string& address, std::size_t start) {
    return log_
        .Await(
            [&](const Json& event) {
              return event["event"] == "hands" && hand < event["hands"].size() &&
                     event["hands"][hand]["device"]["address"] == address;
            },
            start)
        .has_value();
  }

  EventLog log_;
  Workbench bench_;
  std::size_t hand_{0};  ///< That takes the peg.
  Pose X_WB_start_;
  Pose X_WH_;
  Pose X_HB_;
};

TEST_F(WorkbenchTest, OpeningTellsOfItsProgressThenOfTheScene) {
  OpenPeg();
  EXPECT_TRUE(log_.Await("progress"));
  EXPECT_EQ((*log_.Await("scene"))["epoch"], 1);
  const auto scene = bench_.scene();
  EXPECT_EQ(scene->model->bodies.size(), 2u);
  EXPECT_EQ(scene->glb->substr(0, 4), "glTF");
  EXPECT_EQ(bench_.state().parts.size(), 2u);
  EXPECT_TRUE(AwaitTrue([this] { return bench_.frame().epoch == 1; }));
}

TEST_F(WorkbenchTest, WhatCannotBeOpenedLeavesWhatIsOpen) {
  OpenPeg();
  const auto before = bench_.scene();
  bench_.Open("missing", "missing");
  const auto failed = log_.Await("failed");
  ASSERT_TRUE(failed);
  EXPECT_EQ((*failed)["error"]["code"], "not-found");
  EXPECT_EQ((*failed)["error"]["remedy"], "name another");
  EXPECT_EQ(bench_.scene(), before);
}

TEST_F(WorkbenchTest, PartIsTakenMovedAlongItsAxisAndSeated) {
  OpenPeg();
  TakePeg();
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kHeld));
  EXPECT_FALSE(bench_.Take(hand_, OccurrenceId(kPeg)));  // one part in a hand
  EXPECT_FALSE(bench_.Undo());
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  const std::size_t start = log_.size();
  ReleasePeg();
  const auto dropped = log_.Await("dropped", start);
  ASSERT_TRUE(dropped);
  EXPECT_EQ((*dropped)["was_seated"], true);
  EXPECT_EQ((*dropped)["to_place_mm"], 0);
  EXPECT_EQ((*dropped)["occurrence"], kPeg);
  EXPECT_GT((*dropped)["metrics"]["time_s"], 1);
  EXPECT_GT((*dropped)["metrics"]["path_mm"], 50);
  EXPECT_TRUE(AwaitPlacementEvent("placed", start));
  const Pose X_WB = bench_.state().parts[kPeg].X_WB;
  EXPECT_LT((X_WB.p() - bench_.scene()->model->bodies[kPeg].X_WB_goal.p()).norm(), 1e-6);
}

TEST_F(WorkbenchTest, SeatedPartIsTakenOutAgain) {  // X16
  OpenPeg();
  EXPECT_FALSE(bench_.Take(hand_, OccurrenceId(kBlock)));  // stands in its fixture
  TakePeg();
  InsertPeg();
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), X_WB_start_.p() + Vec3(0.05, 0, 0.08)), 2);
  ReleasePeg();
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  EXPECT_TRUE(AwaitTrue([this] { return bench_.state().next_step == 1; }));  // to be done again
  ASSERT_TRUE(bench_.Undo());
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
}

TEST_F(WorkbenchTest, WhatWasDoneIsUndoneAndDoneAgain) {
  OpenPeg();
  const Vec3 p_before = bench_.state().parts[kPeg].X_WB.p();
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  const auto history = log_.Await(
      [](const Json& event) { return event["event"] == "history" && event["undo"].is_string(); });
  ASSERT_TRUE(history);
  EXPECT_EQ((*history)["undo"], "insert peg");
  std::size_t start = log_.size();
  ASSERT_TRUE(bench_.Undo());
  EXPECT_TRUE(AwaitPlacementEvent("loose", start));
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  EXPECT_LT((bench_.state().parts[kPeg].X_WB.p() - p_before).norm(), 1e-3);
  start = log_.size();
  ASSERT_TRUE(bench_.Redo());
  EXPECT_TRUE(AwaitPlacementEvent("placed", start));
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
}

TEST_F(WorkbenchTest, HeldPartStaysAndTheForceGoesWhenNothingIsHeard) {  // N11: 250 ms
  OpenPeg();
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, 0.05))), 0.6);
  // Nobody sends anything any more: the operator is gone.
  auto before = bench_.frame().frame;
  EXPECT_TRUE(AwaitTrue([&] {
    before = bench_.frame().frame;
    return before.ticks.size() == 1 && before.ticks[0].F_H_W.f.norm() == 0 &&
           before.ticks[0].F_H_W.t.norm() == 0;
  }));
  auto after = before;
  EXPECT_TRUE(AwaitTrue([&] {
    after = bench_.frame().frame;
    return after.t_ns > before.t_ns + 300'000'000;
  }));
  EXPECT_LT((after.X_WB[kPeg].p() - before.X_WB[kPeg].p()).norm(), 1e-4);
  EXPECT_EQ(PlacementOf(kPeg), Placement::kHeld);  // neither dropped nor moved on
}

TEST_F(WorkbenchTest, ForcesAreOffUntilTheyAreSwitchedOn) {  // N6
  OpenPeg();
  TakePeg();
  // Down into the table: a force, if there may be one.
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, -0.01))), 0.3);
  const auto force = [this] {
    bench_.Move(hand_, X_WH_, true);
    const auto frame = bench_.frame().frame;
    return frame.ticks.empty() ? 0.0 : frame.ticks[0].F_H_W.f.norm();
  };
  EXPECT_TRUE(AwaitTrue([&] { return force() > 0.1; }));
  bench_.SetForcesOff(true);
  EXPECT_TRUE(bench_.forces_off());
  EXPECT_TRUE(AwaitTrue([&] { return force() == 0; }));
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(force(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  bench_.SetForcesOff(false);
  EXPECT_TRUE(AwaitTrue([&] { return force() > 0.1; }));
}

TEST_F(WorkbenchTest, ForcesStayOffInTheNextRun) {  // N6
  bench_.SetForcesOff(true);
  OpenPeg();
  EXPECT_TRUE(bench_.forces_off());
  TakePeg();
  MovePeg(Pose(X_WB_start_.q(), Vec3(X_WB_start_.p() + Vec3(0, 0, -0.01))), 0.3);
  for (int i = 0; i < 30; ++i) {
    bench_.Move(hand_, X_WH_, true);
    const auto frame = bench_.frame().frame;
    ASSERT_EQ(frame.ticks.size(), 1u);
    EXPECT_EQ(frame.ticks[0].F_H_W.f.norm(), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

TEST_F(WorkbenchTest, ChangeOfTheProductIsCompiledAndUndone) {
  OpenPeg();
  const auto before = bench_.scene();
  ASSERT_FALSE(before->model->product->mates.empty());
  EXPECT_FALSE(bench_.Change({"nothing", nullptr, [](product::Product*) -> Result<void> {
                                return Fail(ErrorCode::kInvalid, "no", "", "");
                              }}));
  std::size_t start = log_.size();
  ASSERT_TRUE(bench_.Change({"change", nullptr, [](product::Product* product) -> Result<void> {
                               product->name = "changed";
                               return {};
                             }}));
  EXPECT_EQ((*log_.Await("scene", start))["why"], "change");
  EXPECT_EQ(bench_.scene()->model->product->name, "changed");
  EXPECT_EQ(before->model->product->name, "rig");  // a model is compiled, never edited
  ASSERT_TRUE(AwaitTrue([&] { return bench_.state().parts.size() == 2; }));
  start = log_.size();
  ASSERT_TRUE(bench_.Undo());
  EXPECT_EQ((*log_.Await("scene", start))["why"], "undone");
  EXPECT_EQ(bench_.scene(), before);
}

TEST_F(WorkbenchTest, SimulatedPersonDoesTheNextStep) {
  OpenPeg();
  ASSERT_TRUE(AwaitTrue([this] { return bench_.state().next_step == 1; }));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.DoNext());
  ASSERT_TRUE(AwaitPlacementEvent("placed", start));
  const auto ended = log_.Await(
      [](const Json& event) { return event["event"] == "demo" && event["on"] == false; }, start);
  EXPECT_TRUE(ended);
  EXPECT_FALSE(bench_.is_demo());
  EXPECT_EQ(PlacementOf(kPeg), Placement::kPlaced);
}

TEST_F(WorkbenchTest, SecondHandDoesWhatTheFirstOneDoes) {  // N11: two hands
  OpenPeg();
  EXPECT_FALSE(bench_.Take(1, OccurrenceId(kPeg)));  // there is one hand only
  EXPECT_FALSE(bench_.SetHandCount(3));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.SetHandCount(2));
  ASSERT_TRUE(AwaitDevice(1, HandRack::kPointer, start));
  hand_ = 1;
  TakePeg();
  EXPECT_FALSE(bench_.Take(0, OccurrenceId(kPeg)));  // it is in the other hand
  EXPECT_FALSE(bench_.SetHandCount(1));
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(bench_.frame().frame.ticks.size(), 2u);
  EXPECT_FALSE(bench_.frame().frame.ticks[0].occurrence.is_valid());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  ASSERT_TRUE(bench_.Undo());
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  ASSERT_TRUE(bench_.SetHandCount(1));
  EXPECT_TRUE(AwaitTrue([this] { return bench_.frame().frame.ticks.size() == 1; }));
}

TEST_F(WorkbenchTest, EmulatedDeviceInsertsThePegByThePointer) {  // N3
  OpenPeg();
  constexpr const char* kAddress = "emulated:openhaptics:touch_x";
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.UseDevice(0, kAddress, 0));
  ASSERT_TRUE(AwaitDevice(0, kAddress, start));
  EXPECT_TRUE(AwaitTrue([this] { return bench_.hands()[0]["condition"] == "ready"; }));
  const Json hand = bench_.hands()[0];
  EXPECT_EQ(hand["device"]["is_emulated"], true);
  EXPECT_GT(hand["device"]["max_force_n"], 1);
  EXPECT_GT(hand["device"]["scale"], 0);
  EXPECT_FALSE(hand["device"]["notes"].empty());
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  ASSERT_TRUE(bench_.UseDevice(0, HandRack::kPointer, 0));
  EXPECT_TRUE(AwaitDevice(0, HandRack::kPointer, start));
}

TEST_F(WorkbenchTest, DeviceThatCannotBeUsedIsToldOfAndLeavesTheHandAsItWas) {
  const auto fails = [this](std::size_t hand, const std::string& address) {
    const std::size_t start = log_.size();
    EXPECT_TRUE(bench_.UseDevice(hand, address, 0));
    const auto failed = log_.Await("failed", start);
    return failed && (*failed)["file"] == address && !(*failed)["error"]["remedy"].empty();
  };
  EXPECT_TRUE(fails(0, "nonsense"));
  EXPECT_TRUE(fails(0, "emulated:openhaptics:nonsense"));
  EXPECT_TRUE(fails(1, "emulated:openhaptics"));  // there is one hand
  EXPECT_EQ(bench_.hands()[0]["device"]["address"], HandRack::kPointer);
  ASSERT_TRUE(bench_.SetHandCount(2));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.UseDevice(0, "emulated:haply", 0));
  ASSERT_TRUE(AwaitDevice(0, "emulated:haply", start));
  EXPECT_TRUE(fails(1, "emulated:haply"));  // it is in the other one
}

TEST_F(WorkbenchTest, DevicesAreFoundWithoutOpeningThem) {
  bench_.SearchDevices();
  const auto told = log_.Await("devices");
  ASSERT_TRUE(told);
  EXPECT_EQ((*told)["is_searching"], false);
  std::size_t emulated = 0;
  for (const Json& device : (*told)["devices"]) {
    emulated += device["is_emulated"] == true ? 1 : 0;
    EXPECT_FALSE(device["address"].get<std::string>().empty());
    EXPECT_FALSE(device["name"].get<std::string>().empty());
  }
  EXPECT_EQ(emulated, device::KnownProfiles().size());
  EXPECT_EQ((*told)["devices"].size(), emulated + device::Drivers().size());
}

TEST_F(WorkbenchTest, RecordingIsListedPlayedAndRunAgainBitForBit) {  // X14, N7
  EXPECT_FALSE(bench_.StartRecording(""));                            // nothing is open
  OpenPeg();
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.StartRecording("first try"));
  const auto begun = log_.Await("recording", start);
  ASSERT_TRUE(begun);
  EXPECT_EQ((*begun)["on"], true);
  const std::string id = (*begun)["id"];
  EXPECT_FALSE(bench_.StartRecording("another"));
  EXPECT_FALSE(bench_.DeleteRecording(id));
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  const std::int64_t worked_ns = bench_.frame().frame.t_ns;
  ASSERT_TRUE(bench_.Undo());  // another stretch
  ASSERT_TRUE(AwaitTrue([&] {
    const std::int64_t t_ns = bench_.frame().frame.t_ns;
    return t_ns > 200'000'000 && t_ns < worked_ns;
  }));
  EXPECT_EQ(PlacementOf(kPeg), Placement::kLoose);
  ASSERT_TRUE(bench_.StopRecording());
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "recording" && e["on"] == false; }, start));
  EXPECT_FALSE(bench_.StopRecording());
  EXPECT_TRUE(bench_.recording().is_null());

  const Json list = bench_.shelf().List()["recordings"];
  const auto listed =
      std::find_if(list.begin(), list.end(), [&](const Json& entry) { return entry["id"] == id; });
  ASSERT_NE(listed, list.end());
  EXPECT_EQ((*listed)["name"], "first try");
  EXPECT_EQ((*listed)["is_complete"], true);
  EXPECT_GT((*listed)["duration_s"], 4);

  const auto detail = bench_.shelf().Describe(id);
  ASSERT_TRUE(detail) << detail.error().ToString();
  ASSERT_EQ((*detail)["results"].size(), 1u);
  const Json& result = (*detail)["results"][0];
  EXPECT_EQ(result["occurrence"], kPeg);
  EXPECT_EQ(result["is_seated"], true);
  EXPECT_GT(result["time_s"], 1);
  EXPECT_GT(result["path_m"], 0.05);
  CheckFrames(*bench_.shelf().ReadFrames(id));
  const auto scene = bench_.shelf().ReadAttachment(id, kSceneAttachment);
  ASSERT_TRUE(scene);
  EXPECT_EQ(Json::parse(*scene)["occurrences"].size(), 2u);
  EXPECT_EQ(*bench_.shelf().ReadAttachment(id, kGlbAttachment), *bench_.scene()->glb);

  auto reader = record::Reader::Open(*bench_.shelf().Find(id));
  ASSERT_TRUE(reader);
  const auto replay = session::Replay(&*reader, bench_.scene()->model, {});
  ASSERT_TRUE(replay) << replay.error().ToString();
  EXPECT_TRUE(replay->is_exact());
  EXPECT_EQ(replay->stretches, 2);
  EXPECT_GT(replay->ticks, 4000);

  EXPECT_TRUE(bench_.DeleteRecording(id));
  EXPECT_FALSE(bench_.shelf().Find(id));
}

TEST_F(WorkbenchTest, ChangeOfTheProductEndsTheRecording) {
  OpenPeg();
  ASSERT_TRUE(bench_.StartRecording(""));
  ASSERT_TRUE(log_.Await("recording"));
  const std::size_t start = log_.size();
  ASSERT_TRUE(
      bench_.Change({"change", nullptr, [](product::Product*) -> Result<void> { return {}; }}));
  const auto ended = log_.Await("recording", start);
  ASSERT_TRUE(ended);
  EXPECT_EQ((*ended)["on"], false);
  const auto described = bench_.shelf().Describe((*ended)["id"]);
  ASSERT_TRUE(described);
  EXPECT_EQ((*described)["is_complete"], true);
}

TEST_F(WorkbenchTest, RecordingThatVanishesIsToldOfAndWorkGoesOn) {
  OpenPeg();
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.StartRecording(""));
  const auto begun = log_.Await("recording", start);
  ASSERT_TRUE(begun);
  const auto file = bench_.shelf().Find((*begun)["id"]);
  ASSERT_TRUE(file);
  std::filesystem::remove(*file);
  const auto failed = log_.Await("failed", start);
  ASSERT_TRUE(failed);
  EXPECT_EQ((*failed)["file"], "recording");
  const std::string message = (*failed)["error"]["message"];
  EXPECT_NE(message.find("removed or replaced"), std::string::npos) << message;
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "recording" && e["on"] == false; }, start));
  EXPECT_TRUE(bench_.recording().is_null());
  TakePeg();
  EXPECT_FALSE(HasFatalFailure());
}

TEST_F(WorkbenchTest, RecordingsHaveNamesOfTheirOwnAndOthersWhenTheyAreGiven) {
  OpenPeg();
  std::vector<std::string> ids;
  for (int i = 0; i < 2; ++i) {
    const std::size_t start = log_.size();
    ASSERT_TRUE(bench_.StartRecording(""));
    ASSERT_TRUE(
        log_.Await([](const Json& e) { return e["event"] == "recording" && e["on"]; }, start));
    ASSERT_TRUE(bench_.StopRecording());
    const auto ended =
        log_.Await([](const Json& e) { return e["event"] == "recording" && !e["on"]; }, start);
    ASSERT_TRUE(ended);
    ids.push_back((*ended)["id"]);
  }
  const auto name_of = [this](const std::string& id) -> std::string {
    const auto described = bench_.shelf().Describe(id);
    return described ? (*described)["name"] : "";
  };
  EXPECT_NE(name_of(ids[0]), name_of(ids[1]));
  const auto file = bench_.shelf().Find(ids[0]);
  ASSERT_TRUE(file);
  const auto written = std::filesystem::last_write_time(*file);
  ASSERT_TRUE(bench_.RenameRecording(ids[0], "Erster Versuch, H7/p6 \u00e4"));
  EXPECT_EQ(name_of(ids[0]), "Erster Versuch, H7/p6 \u00e4");
  EXPECT_EQ(std::filesystem::last_write_time(*file), written) << "the record stays as it was";
  bool is_listed = false;
  const Json list = bench_.shelf().List();
  for (const Json& entry : list["recordings"]) {
    is_listed = is_listed || (entry["id"] == ids[0] && entry["name"] == name_of(ids[0]));
  }
  EXPECT_TRUE(is_listed);
  for (const std::string& bad : {std::string(), std::string("  "), std::string(300, 'x')}) {
    EXPECT_FALSE(bench_.RenameRecording(ids[0], bad)) << bad;
  }
  EXPECT_FALSE(bench_.RenameRecording("../none", "x"));
  for (const std::string& id : ids) {
    EXPECT_TRUE(bench_.DeleteRecording(id));
  }
}

TEST_F(WorkbenchTest, RecordingsAreFoundByTheirIdAlone) {
  for (const char* id : {"", ".", "..", "../../etc/passwd", "/etc/passwd", "a/b", "none"}) {
    EXPECT_FALSE(bench_.shelf().Find(id)) << id;
    EXPECT_FALSE(bench_.DeleteRecording(id)) << id;
    EXPECT_FALSE(bench_.shelf().ReadFrames(id)) << id;
  }
}

TEST_F(WorkbenchTest, StopsWhileAFileIsBeingOpened) {
  bench_.Open("peg.step", "peg");
  bench_.Open("peg.step", "peg");
  bench_.Stop();
  const std::size_t told = log_.size();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(log_.size(), told);
}

TEST(WorkbenchStopTest, WhatHasNotBegunIsDropped) {
  WorkbenchOptions options = testing::SmallBench();
  options.scenes.load = [load = options.scenes.load](
                            const std::filesystem::path& file, const cad::ProgressFn& progress,
                            const std::stop_token& stop, Diagnostics* diagnostics) {
    while (file == "slow.step" && !stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return load(file, progress, stop, diagnostics);
  };
  Workbench bench(options);
  EventLog log;
  bench.on_event = [&log](Json event) { log.Add(std::move(event)); };
  bench.Open("peg.step", "peg");
  ASSERT_TRUE(log.Await("scene"));
  bench.Open("slow.step", "slow");
  int changes = 0;
  const auto change = [&changes](product::Product*) -> Result<void> {
    ++changes;
    return {};
  };
  ASSERT_TRUE(bench.Change({"behind it", nullptr, change}));  // is tried at once
  bench.Stop();
  EXPECT_EQ(changes, 1);
}

}  // namespace
}  // namespace hvas::studio
