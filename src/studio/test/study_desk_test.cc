// A study at the studio: who may do what, what reaches the participant, trials in real time (N9,
// X14, W8, W11, W12).

#include "studio/study_desk.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/scratch_folder.h"
#include "simulation/test/small_models.h"
#include "studio/hub.h"
#include "studio/scene_json.h"
#include "studio/test/protocol_schema.h"
#include "studio/test/small_bench.h"
#include "study/simulated_study.h"
#include "study/trial_pair.h"

namespace hvas::studio {
namespace {

constexpr std::int64_t kUnixMs = 1'700'000'000'000;
constexpr const char* kProtocol = R"(
format: hvas-study-1
id: desk
title: A peg
product: peg
part: peg
languages: [en, de]
consent: You may stop.
defaults: {time_limit_s: 1}
conditions:
  - {id: Cpick, name: Picked, method: constraints_by_picking, time_limit_s: 60}
  - {id: Cloose, name: Loose one, method: hybrid, fit: H7/g6, instruction: Put it in.}
  - {id: Ctight, name: Tight one, method: hybrid, fit: H7/p6, instruction: Put it in.}
blocks:
  - {id: Btimed, conditions: [Cpick], order: given}
  - {id: Bblind, conditions: [Cloose, Ctight], identification: true, question: Which}
questions:
  - {id: calm, kind: scale, text: How calm, asked: at_end}
)";

class DeskLink final : public ClientLink {
 public:
  void SendText(std::string text) override {
    texts.push_back(std::move(text));
    const Json json = Json::parse(texts.back());
    const std::string fault = json.value("ok", false)
                                  ? testing::FindResultFault("study", json["result"])
                                  : (json.contains("ok") ? "" : testing::FindEventFault(json));
    EXPECT_EQ(fault, "") << json;
  }

  void SendFrames(std::string bytes) override { frames.push_back(std::move(bytes)); }

  void Close(const std::string&) override {}

  /** Reads all items of a kind out of the binary messages. */
  template <typename Item>
  [[nodiscard]] std::vector<Item> Items() const {
    std::vector<Item> items;
    for (std::string_view bytes : frames) {
      while (!bytes.empty()) {
        protocol::Header header;
        std::memcpy(&header, bytes.data(), sizeof(header));
        if (header.kind == static_cast<std::uint16_t>(protocol::kKindOf<Item>)) {
          const std::size_t first = items.size();
          items.resize(first + header.count);
          std::memcpy(items.data() + first, bytes.data() + sizeof(header),
                      header.count * sizeof(Item));
        }
        bytes.remove_prefix(header.size);
      }
    }
    return items;
  }

  std::vector<std::string> texts;
  std::vector<std::string> frames;
};

/** Tells whether any of these components of a force or torque is not zero. */
template <std::size_t kSize>
bool IsSome(const std::array<float, kSize>& components) {
  return std::any_of(components.begin(), components.end(), [](float c) { return c != 0; });
}

/** Hub, bench and desk, driven by the test's thread alone, as by the server's. */
class StudyDeskTest : public ::testing::Test {
 protected:
  StudyDeskTest() : bench_(testing::SmallBench(log_.clock())), hub_(&bench_, {}) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
    Open(false);
  }

  void TearDown() override { bench_.Stop(); }

  void Open(bool has_person, const std::string& text = kProtocol,
            const std::string& name = "study") {
    desk_.reset();
    const auto protocol = study::ParseProtocol(text, "desk.yaml");
    ASSERT_TRUE(protocol) << protocol.error().ToString();
    auto folder = study::StudyFolder::Create(scratch_.path() / name, *protocol, 1);
    ASSERT_TRUE(folder) << folder.error().ToString();
    StudyDesk::Options options;
    options.participant = "P01";
    options.product = "peg.step";
    options.has_person = has_person;
    options.unix_ms = [] { return kUnixMs; };
    auto desk = StudyDesk::Open(std::move(*folder), &bench_, std::move(options));
    ASSERT_TRUE(desk) << desk.error().ToString();
    desk_ = std::move(*desk);
    hub_.SetStudyDesk(desk_.get());
  }

  void Join() {
    experimenter_ = *hub_.Join({Role::kOperator, true, 1}, &experimenter_link_, 0);
    participant_ = *hub_.Join({Role::kParticipant, false, 2}, &participant_link_, 0);
  }

  /** Passes on what the bench tells until an event has come, as the server does. */
  void PumpUntil(const std::string& name) {
    for (;;) {
      const auto event = log_.Await([](const Json&) { return true; }, pumped_);
      ASSERT_TRUE(event) << "waiting for " << name;
      ++pumped_;
      hub_.Broadcast(*event);
      if ((*event)["event"] == name) {
        return;
      }
    }
  }

  /** The participant picks the two surfaces of a mate. @returns the answer. */
  Json PickMate(product::MateId id) {
    const auto scene = bench_.live().scene();
    const product::Mate& mate = scene->model->product->mates[id.index()];
    const auto face_of = [&](const product::Connector& side) {
      const product::Part& part = scene->model->product->part_of(side.occurrence);
      return Json{{"occurrence", side.occurrence.value()},
                  {"face", part.features[side.feature.index()].faces.front().value()}};
    };
    return Ask(participant_, {{"action", "pick"}, {"a", face_of(mate.a)}, {"b", face_of(mate.b)}});
  }

  Json Ask(const std::string& id, Json command) {
    DeskLink& link = id == participant_ ? participant_link_ : experimenter_link_;
    command["id"] = ++last_id_;
    command["command"] = "study";
    now_ns_ += 1'000'000'000;
    const std::size_t from = link.texts.size();
    hub_.OnText(id, command.dump(), now_ns_);
    for (std::size_t i = from; i < link.texts.size(); ++i) {
      if (Json reply = Json::parse(link.texts[i]); reply.contains("ok")) {
        return reply;
      }
    }
    return nullptr;
  }

  /** @returns the phase after it, or the error's message. */
  std::string Do(const std::string& id, const Json& command) {
    const Json reply = Ask(id, command);
    return reply["ok"] == true ? reply["result"]["state"]["phase"].get<std::string>()
                               : reply["error"]["message"].get<std::string>();
  }

  /** Of the trial on the bench [s]. */
  void AwaitElapsed(double seconds) {
    ASSERT_TRUE(
        log_.AwaitTrue([&] { return bench_.trials().trial()->watch().elapsed_s() >= seconds; }));
  }

  std::string Phase() {
    return desk_->MakeState(Role::kOperator, now_ns_)["phase"].get<std::string>();
  }

  void BeginTrials() {
    Join();
    desk_->Start();
    PumpUntil("scene");
    ASSERT_EQ(Do(experimenter_, {{"action", "begin"}}), "consent");
    ASSERT_EQ(Do(participant_, {{"action", "consent"}, {"agreed", true}, {"language", "de"}}),
              "ready");
  }

  ScratchFolder scratch_ = *ScratchFolder::Make();
  testing::EventLog log_;
  Workbench bench_;
  Hub hub_;
  std::unique_ptr<StudyDesk> desk_;
  DeskLink experimenter_link_;
  DeskLink participant_link_;
  std::string experimenter_;
  std::string participant_;
  std::size_t pumped_{0};
  int last_id_{0};
  std::int64_t now_ns_{1'000'000'000};
};

TEST_F(StudyDeskTest, NobodyGivesTheParticipantsHandAwayOrTakesIt) {
  Join();
  DeskLink other_link;
  const std::string other = *hub_.Join({Role::kOperator, false, 3}, &other_link, 0);
  const auto lease = [this](const std::string& id, DeskLink* link, Json command) {
    command["command"] = "lease";
    command["id"] = 7;
    link->texts.clear();
    hub_.OnText(id, command.dump(), 1'000'000'000);
    for (const std::string& text : link->texts) {
      const Json json = Json::parse(text);
      if (json.value("id", 0) == 7) {
        return json["ok"].get<bool>();
      }
    }
    return true;
  };
  for (const Json& command :
       {Json{{"action", "give"}, {"to", other}}, Json{{"action", "give"}, {"to", experimenter_}},
        Json{{"action", "release"}}, Json{{"action", "request"}},
        Json{{"action", "give"}, {"to", other}, {"hand", 0}}}) {
    EXPECT_FALSE(lease(participant_, &participant_link_, command)) << command;
    EXPECT_FALSE(lease(experimenter_, &experimenter_link_, command)) << command;
  }
  EXPECT_EQ(Json::parse(other_link.texts.front())["event"], "hello");
  DeskLink late_link;
  (void)*hub_.Join({Role::kOperator, false, 4}, &late_link, 0);
  for (const std::string& text : late_link.texts) {
    const Json json = Json::parse(text);
    if (json["event"] == "roles") {
      for (const Json& client : json["clients"]) {
        EXPECT_EQ(client["has_lease"], client["id"] == participant_);
      }
    }
  }
}

TEST_F(StudyDeskTest, EachLinkMayDoWhatIsItsOwn) {
  Join();
  EXPECT_NE(Do(participant_, {{"action", "begin"}}), "consent");
  EXPECT_NE(Do(experimenter_, {{"action", "consent"}, {"agreed", true}}), "ready");
  EXPECT_EQ(Do(participant_, {{"action", "state"}}), "waiting");
  for (const char* command : {"open", "undo", "demo", "assign_fit", "recordings", "measure"}) {
    now_ns_ += 1'000'000'000;
    participant_link_.texts.clear();
    hub_.OnText(participant_, Json{{"id", 1}, {"command", command}}.dump(), now_ns_);
    ASSERT_EQ(participant_link_.texts.size(), 1U);
    EXPECT_EQ(Json::parse(participant_link_.texts[0])["ok"], false) << command;
  }
}

TEST_F(StudyDeskTest, ExperimenterAloneIsToldOfTheParticipantsLink) {
  desk_->SetParticipantLink("/#t=secret");
  EXPECT_EQ(desk_->MakeState(Role::kOperator, 0)["link"], "/#t=secret");
  for (const Role role : {Role::kParticipant, Role::kViewer}) {
    EXPECT_EQ(desk_->MakeState(role, 0).dump().find("secret"), std::string::npos);
  }
}

TEST_F(StudyDeskTest, W8ConstraintsArePickedAndTheTrialIsDone) {  // A1
  BeginTrials();
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_begun");
  EXPECT_EQ(desk_->MakeState(Role::kParticipant, now_ns_)["method"], "picking");
  EXPECT_FALSE(desk_->CheckTake());
  AwaitElapsed(0.01);
  const Json wrong = Ask(participant_, {{"action", "pick"},
                                        {"a", {{"occurrence", 0}, {"face", 0}}},
                                        {"b", {{"occurrence", 0}, {"face", 1}}}});
  EXPECT_EQ(wrong["result"]["is_set"], false);
  const auto constraints = bench_.trials().ListConstraints();
  ASSERT_FALSE(constraints.empty());
  Json last;
  for (const product::MateId id : constraints) {
    last = PickMate(id);
    EXPECT_EQ(last["result"]["is_set"], true) << last.dump();
  }
  EXPECT_EQ(last["result"]["left"], 0);
  PumpUntil("trial_over");
  EXPECT_EQ(Phase(), "ready");
  const Json state = desk_->MakeState(Role::kOperator, now_ns_);
  EXPECT_EQ(state["done"][0]["outcome"], "done");
  EXPECT_GT(state["done"][0]["time_s"].get<double>(), 0);
}

TEST_F(StudyDeskTest, X14ThePickedAxisGuidesThePartThatIsTakenAfterIt) {  // condition 2
  std::string text = kProtocol;
  const std::string method = "method: constraints_by_picking";
  text.replace(text.find(method), method.size(), "method: constraint_only, constraints: picked");
  Open(false, text, "picked");
  BeginTrials();
  EXPECT_EQ(desk_->MakeState(Role::kParticipant, now_ns_)["method"], "picking");
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_begun");
  EXPECT_FALSE(desk_->CheckTake());
  const auto constraints = bench_.trials().ListConstraints();
  ASSERT_EQ(constraints.size(), 1U);  // of axis and face, the axis
  const Json picked = PickMate(constraints.front());
  EXPECT_EQ(picked["result"]["is_set"], true) << picked.dump();
  EXPECT_EQ(picked["result"]["left"], 0);
  EXPECT_EQ(picked["result"]["state"]["method"], "hand");
  EXPECT_EQ(Phase(), "running");  // the part is still to be put in its place
  EXPECT_TRUE(desk_->CheckTake());
  EXPECT_EQ(PickMate(constraints.front())["ok"], false);
}

TEST_F(StudyDeskTest, W12BlindFitsDoNotReachTheParticipant) {
  BeginTrials();
  for (int trial = 0; trial < 3; ++trial) {
    ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
    PumpUntil("trial_begun");
    const std::string scene =
        MakeShieldedSceneJson(*bench_.live().scene(), bench_.live().state()).dump();
    for (const char* secret : {"H7/", "clearance", "interference", "Ctight", "Tight"}) {
      EXPECT_EQ(scene.find(secret), std::string::npos) << secret;
    }
    ASSERT_EQ(Do(experimenter_, {{"action", "next"}}), "running");
    PumpUntil("trial_over");
    if (trial > 0) {
      ASSERT_EQ(Phase(), "question");
      const Json choices = desk_->MakeState(Role::kParticipant, now_ns_)["question"]["choices"];
      EXPECT_EQ(choices.dump(), R"([{"id":"H7/g6","text":"H7/g6"},{"id":"H7/p6","text":"H7/p6"}])");
      Do(participant_, {{"action", "answer"}, {"question", "identify"}, {"value", "H7/p6"}});
    }
  }
  EXPECT_EQ(Do(participant_, {{"action", "answer"}, {"question", "calm"}, {"value", 9}}), "done");
  int with_choices = 0;
  for (std::string text : participant_link_.texts) {
    // The answers to choose from are the same for all trials.
    const std::string choices = R"([{"id":"H7/g6","text":"H7/g6"},{"id":"H7/p6","text":"H7/p6"}])";
    for (std::size_t at = text.find(choices); at != std::string::npos; at = text.find(choices)) {
      text.erase(at, choices.size());
      ++with_choices;
    }
    for (const char* secret : {"H7/", "Ctight", "Cloose", "Tight", "Loose", "Bblind", "true_n",
                               "clearance", "interference"}) {
      EXPECT_EQ(text.find(secret), std::string::npos) << secret << " in " << text;
    }
  }
  EXPECT_GT(with_choices, 1);
  bool does_experimenter_see = false;
  for (const std::string& text : experimenter_link_.texts) {
    does_experimenter_see = does_experimenter_see || text.find("H7/p6") != std::string::npos;
  }
  EXPECT_TRUE(does_experimenter_see);
}

TEST_F(StudyDeskTest, W12BinaryFramesHoldTheTrueForceForTheExperimenterAlone) {
  std::string text = kProtocol;
  text.replace(text.find("time_limit_s: 1}"), 16, "time_limit_s: 600}");
  Open(false, text, "pressed");
  BeginTrials();
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_begun");
  ASSERT_EQ(Do(experimenter_, {{"action", "next"}}), "running");  // past the trial by picking
  PumpUntil("trial_over");
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_begun");
  const auto taken = bench_.hands().Take(0, product::OccurrenceId(1));
  ASSERT_TRUE(taken) << taken.error().ToString();
  // The peg is pressed downwards until the experimenter sees by which force.
  const auto is_pressed = [](const DeskLink& link) {
    const auto hands = link.Items<protocol::HandState>();
    const auto contacts = link.Items<protocol::ContactPoint>();
    return std::any_of(hands.begin(), hands.end(),
                       [](const auto& hand) { return IsSome(hand.f_true_W_n); }) &&
           std::any_of(contacts.begin(), contacts.end(),
                       [](const auto& contact) { return IsSome(contact.f_C_W_n); });
  };
  double below = 0;
  ASSERT_TRUE(log_.AwaitTrue([&] {
    below = std::min(below + 0.2e-3, 0.2);
    bench_.hands().Move(0, spatial::Pose(taken->X_WH.q(), taken->X_WH.p() - Vec3(0, 0, below)),
                        true);
    hub_.PublishFrame();
    for (const auto& [id, link] : {std::pair(experimenter_, &experimenter_link_),
                                   std::pair(participant_, &participant_link_)}) {
      const protocol::Acknowledgement credit{static_cast<std::uint32_t>(link->frames.size())};
      std::string bytes;
      AppendFrame<protocol::Acknowledgement>(std::span(&credit, 1), 1, 1, 0, &bytes);
      hub_.OnBinary(id, bytes);
    }
    return is_pressed(experimenter_link_);
  }));
  bool is_felt = false;
  for (const protocol::HandState& hand : participant_link_.Items<protocol::HandState>()) {
    EXPECT_FALSE(IsSome(hand.f_true_W_n));
    EXPECT_FALSE(IsSome(hand.t_true_W_nm));
    EXPECT_EQ(hand.axial_true_n, 0);
    is_felt = is_felt || IsSome(hand.f_felt_W_n);
  }
  EXPECT_TRUE(is_felt);
  const auto contacts = participant_link_.Items<protocol::ContactPoint>();
  EXPECT_FALSE(contacts.empty());
  for (const protocol::ContactPoint& contact : contacts) {
    EXPECT_FALSE(IsSome(contact.f_C_W_n));
  }
}

// A person, live, and the simulated participant of the same number and seed get the same pairs.
TEST_F(StudyDeskTest, W12LiveAndSimulatedTrialsHaveTheSamePairs) {
  BeginTrials();
  for (int trial = 0; trial < 3; ++trial) {
    ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
    PumpUntil("trial_begun");
    ASSERT_EQ(Do(experimenter_, {{"action", "next"}}), "running");
    PumpUntil("trial_over");
    if (trial > 0) {
      Do(participant_, {{"action", "answer"}, {"question", "identify"}, {"value", "H7/p6"}});
    }
  }
  const auto live = (*study::StudyFolder::Open(scratch_.path() / "study")).ReadParticipant("P01");
  ASSERT_TRUE(live) << live.error().ToString();
  const auto folder = study::StudyFolder::Create(scratch_.path() / "simulated",
                                                 *study::ParseProtocol(kProtocol, "desk.yaml"), 1);
  const auto models =
      [](const study::Condition& condition,
         const std::string& part) -> Result<std::shared_ptr<const simulation::Model>> {
    auto product = std::make_shared<product::Product>(simulation::testing::PegInBlock());
    if (const auto applied = study::ApplyFit(condition, part, product.get()); !applied) {
      return Unexpected(applied.error());
    }
    Diagnostics diagnostics;
    return simulation::Compile(product, simulation::testing::FastOptions(), &diagnostics);
  };
  const auto run = study::RunSimulatedStudy(*folder, models, {});
  ASSERT_TRUE(run) << run.error().ToString();
  const auto simulated = folder->ReadParticipant("P01");
  const auto& live_trials = live->session->done();
  const auto& simulated_trials = simulated->session->done();
  ASSERT_EQ(live_trials.size(), 3U);
  ASSERT_EQ(simulated_trials.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) {  // the first one is done by picking, with the product's fit
    ASSERT_TRUE(live_trials[i].result.pair.has_value()) << i;
    ASSERT_TRUE(simulated_trials[i].result.pair.has_value()) << i;
    const study::TrialPair& a = *live_trials[i].result.pair;
    const study::TrialPair& b = *simulated_trials[i].result.pair;
    EXPECT_EQ(a.hole_diameter, b.hole_diameter);
    EXPECT_EQ(a.shaft_diameter, b.shaft_diameter);
    EXPECT_EQ(a.clearances, b.clearances);
    EXPECT_EQ(a.clearances.size(), 21U);
  }
  EXPECT_NE(live_trials[1].result.pair->clearances, live_trials[2].result.pair->clearances);
}

TEST_F(StudyDeskTest, TimesOutByTheTickClockAndAbortsCountForNothing) {
  BeginTrials();
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_begun");
  const std::string too_long =
      Do(experimenter_, {{"action", "abort"}, {"reason", std::string(4001, 'x')}});
  EXPECT_NE(too_long.find("reason"), std::string::npos) << too_long;
  ASSERT_EQ(Do(experimenter_, {{"action", "abort"}, {"reason", "telephone"}}), "paused");
  PumpUntil("trial_over");
  ASSERT_EQ(Do(experimenter_, {{"action", "note"}, {"text", "rang twice"}}), "paused");
  ASSERT_EQ(Do(experimenter_, {{"action", "resume"}}), "ready");
  const Json state = desk_->MakeState(Role::kOperator, now_ns_);
  EXPECT_EQ(state["trial"], 1);
  EXPECT_TRUE(state["done"].empty());
  EXPECT_EQ(state["interruptions"], 1);
  EXPECT_EQ(state["notes"][0]["text"], "rang twice");
  EXPECT_EQ(state["notes"][0]["unix_ms"], kUnixMs);
  Do(participant_, {{"action", "ready"}});
  PumpUntil("trial_begun");
  Do(experimenter_, {{"action", "next"}});
  PumpUntil("trial_over");
  Do(participant_, {{"action", "ready"}});  // a trial of one second
  PumpUntil("trial_begun");
  AwaitElapsed(1);
  hub_.PublishStatus();
  PumpUntil("trial_over");
  const Json done = desk_->MakeState(Role::kOperator, now_ns_)["done"];
  ASSERT_EQ(done.size(), 2U);
  EXPECT_EQ(done[0]["outcome"], "not_done");
  EXPECT_EQ(done[1]["outcome"], "timed_out");
  EXPECT_DOUBLE_EQ(done[1]["time_s"].get<double>(), 1);
}

TEST_F(StudyDeskTest, PartInItsPlaceEndsTheTrialAndLeavesItsRecord) {
  Open(true);  // the simulated person works
  BeginTrials();
  Do(participant_, {{"action", "ready"}});
  PumpUntil("trial_begun");
  Do(experimenter_, {{"action", "next"}});
  PumpUntil("trial_over");
  ASSERT_EQ(Do(participant_, {{"action", "ready"}}), "running");
  PumpUntil("trial_over");
  EXPECT_EQ(Phase(), "question");
  const Json done = desk_->MakeState(Role::kOperator, now_ns_)["done"][1];
  EXPECT_EQ(done["outcome"], "done");
  EXPECT_GT(done["time_s"].get<double>(), 1);
  EXPECT_LT(done["time_s"].get<double>(), 30);
  EXPECT_TRUE(
      std::filesystem::exists(scratch_.path() / "study" / "records" / "P01" / "002.hvasrec"));
}

TEST_F(StudyDeskTest, GoesOnAfterTheProgramHasEnded) {
  BeginTrials();
  Do(participant_, {{"action", "ready"}});
  PumpUntil("trial_begun");
  Do(experimenter_, {{"action", "next"}});
  PumpUntil("trial_over");
  hub_.DropClients();
  Open(false);  // as a program that is begun again
  EXPECT_EQ(Phase(), "waiting");
  EXPECT_TRUE(desk_->OnBenchEvent({{"event", "scene"}}, now_ns_));
  ASSERT_TRUE(desk_->Do(Role::kOperator, {{"action", "begin"}}, now_ns_));
  EXPECT_EQ(Phase(), "ready");
  const Json state = desk_->MakeState(Role::kOperator, now_ns_);
  EXPECT_EQ(state["is_resumed"], true);
  EXPECT_EQ(state["interruptions"], 1);
  EXPECT_EQ(state["trial"], 2);
  EXPECT_EQ(state["language"], "de");
}

}  // namespace
}  // namespace hvas::studio
