// What the server sends is what src/studio/protocol.json says, in a session that uses all commands.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "session/deformable_json.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/live_run.h"
#include "studio/scene_json.h"
#include "studio/test/protocol_schema.h"
#include "studio/test/small_bench.h"

namespace hvas::studio {
namespace {

/** A client that holds every event against the schema. */
class CheckedLink final : public ClientLink {
 public:
  void SendText(std::string text) override {
    Json json = Json::parse(text);
    if (json.contains("event") && !json.contains("ok")) {
      EXPECT_EQ(testing::FindEventFault(json), "") << text;
      events.insert(json["event"].get<std::string>());
    } else {
      reply = std::move(json);
    }
  }

  void SendFrames(std::string) override {}

  void Close(const std::string& reason) override { ADD_FAILURE() << reason; }

  std::set<std::string> events;
  std::optional<Json> reply;
};

class ProtocolTest : public ::testing::Test {
 protected:
  ProtocolTest()
      : bench_(testing::SmallBench(log_.clock())), hub_(&bench_, {{"peg", "Peg", "", "peg.step"}}) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
    steers_ = *hub_.Join({Role::kOperator, true, 1}, &link_, now_ns_);
    (void)*hub_.Join({Role::kOperator, false, 2}, &other_link_, now_ns_);
  }

  void TearDown() override { bench_.Stop(); }

  /** @returns the result, or null where the command was refused. */
  Json Do(Json command) { return DoAs(steers_, &link_, std::move(command)); }

  Json DoAs(const std::string& id, CheckedLink* link, Json command) {
    command["id"] = 1;
    now_ns_ += 1'000'000'000;
    link->reply.reset();
    hub_.OnText(id, command.dump(), now_ns_);
    while (!link->reply && !PumpOne().empty()) {  // answered later
    }
    const Json reply = link->reply.value_or(nullptr);
    EXPECT_TRUE(reply.contains("ok")) << command;
    if (reply.value("ok", false)) {
      EXPECT_EQ(testing::FindResultFault(command["command"], reply["result"]), "") << reply;
      return reply["result"];
    }
    EXPECT_EQ(testing::FindFault("ServerError", reply["error"]), "") << reply;
    return nullptr;
  }

  /** Passes an event of the bench on, as the server does. @returns its name; empty: there is none.
   */
  std::string PumpOne() {
    const auto event = log_.Await([](const Json&) { return true; }, pumped_);
    if (!event) {
      return "";
    }
    ++pumped_;
    hub_.Broadcast(*event);
    return event->value("event", "");
  }

  void PumpUntil(const std::string& name) {
    for (std::string told; told != name;) {
      told = PumpOne();
      ASSERT_FALSE(told.empty()) << "waiting for " << name;
    }
  }

  testing::EventLog log_;
  Workbench bench_;
  Hub hub_;
  CheckedLink link_;
  CheckedLink other_link_;
  std::string steers_;
  std::size_t pumped_{0};
  std::int64_t now_ns_{1'000'000'000};
};

TEST(DeformablesTest, EachKindIsAsTheSchemaSays) {
  std::vector<simulation::Deformable> deformables;
  for (int kind = 0; kind <= static_cast<int>(simulation::DeformationKind::kShift); ++kind) {
    deformables.emplace_back().occurrence = product::OccurrenceId(0);
    deformables.back().form.kind = static_cast<simulation::DeformationKind>(kind);
  }
  const Json forms = session::MakeFormsJson(deformables);
  ASSERT_EQ(forms.size(), deformables.size());
  for (const Json& form : forms) {
    EXPECT_EQ(testing::FindFault("Deformable", form), "") << form;
  }
}

TEST_F(ProtocolTest, SessionIsAsTheSchemaSays) {
  bench_.opener().Open("missing", "missing.step");
  PumpUntil("failed");
  EXPECT_FALSE(Do({{"command", "open"}, {"example", "peg"}}).is_null());
  PumpUntil("scene");
  PumpUntil("history");
  const SceneSnapshot now = bench_.live().MakeSnapshot();
  EXPECT_EQ(testing::FindFault("Scene", MakeSceneJson(*now.scene, now.state)), "");
  EXPECT_EQ(testing::FindFault("Scene", MakeShieldedSceneJson(*now.scene, now.state)), "");
  // A page that opens the scene before the first tick sees the base in its place as well.
  const Json before = MakeSceneJson(*now.scene, MakeStart(*now.scene->model));
  for (const Json& occurrence : before["occurrences"]) {
    EXPECT_EQ(occurrence["placement"], occurrence["is_base"] ? "placed" : "loose");
  }

  EXPECT_FALSE(Do({{"command", "record"}, {"on", true}, {"name", "First"}}).is_null());
  PumpUntil("recordings");
  EXPECT_FALSE(Do({{"command", "take"}, {"occurrence", 1}}).is_null());
  PumpUntil("taken");
  EXPECT_FALSE(Do({{"command", "release"}, {"hand", 0}}).is_null());
  PumpUntil("dropped");
  EXPECT_FALSE(Do({{"command", "next"}}).is_null());
  PumpUntil("dropped");
  ASSERT_TRUE(log_.AwaitTrue([&] { return !bench_.live().is_demo(); }));
  EXPECT_FALSE(Do({{"command", "path"}, {"occurrence", 1}, {"as", "points"}}).is_null());
  EXPECT_FALSE(Do({{"command", "path"}, {"occurrence", 1}, {"as", "swept"}}).is_null());
  EXPECT_FALSE(Do({{"command", "record"}, {"on", false}}).is_null());
  PumpUntil("recordings");
  const Json list = bench_.recordings().shelf().List();
  EXPECT_EQ(testing::FindFault("RecordingList", list), "");
  const std::string id = list["recordings"][0]["id"];
  const auto described = bench_.recordings().shelf().Describe(id);
  ASSERT_TRUE(described.has_value()) << described.error().ToString();
  const Json detail = Json::parse(*described);
  EXPECT_EQ(testing::FindFault("RecordingDetail", detail), "");
  EXPECT_FALSE(detail["events"].empty());
  const Json rename{{"command", "rename_recording"}, {"recording", id}, {"name", "Second"}};
  EXPECT_FALSE(Do(rename).is_null());
  EXPECT_FALSE(Do({{"command", "delete_recording"}, {"recording", id}}).is_null());

  const Json a{{"occurrence", 0}, {"face", 0}};
  const Json b{{"occurrence", 1}, {"face", 0}};
  for (const Json& second : {Json(nullptr), a, b}) {
    EXPECT_FALSE(Do({{"command", "measure"}, {"a", a}, {"b", second}}).is_null());
  }
  EXPECT_FALSE(Do({{"command", "assign_fit"}, {"mate", 0}, {"fit", "H7/g6"}}).is_null());
  PumpUntil("scene");
  EXPECT_FALSE(Do({{"command", "undo"}}).is_null());
  PumpUntil("scene");
  EXPECT_FALSE(Do({{"command", "reset"}}).is_null());
  PumpUntil("history");

  const Json found = Do({{"command", "find_orders"}});
  ASSERT_FALSE(found.is_null());
  EXPECT_FALSE(found["orders"].empty());
  const Json parts = Json::array({1});  // The peg is all that may change.
  const Json checked = Do({{"command", "check_order"}, {"occurrences", parts}});
  ASSERT_FALSE(checked.is_null());
  EXPECT_EQ(checked["is_possible"], true);
  EXPECT_FALSE(Do({{"command", "set_order"}, {"occurrences", parts}}).is_null());
  PumpUntil("scene");
  EXPECT_FALSE(Do({{"command", "explain_gap"}, {"occurrence", 1}}).is_null());
  const Json twice = Json::array({1, 1});
  EXPECT_TRUE(Do({{"command", "check_order"}, {"occurrences", twice}}).is_null());
  EXPECT_TRUE(Do({{"command", "check_order"}, {"occurrences", {{"a", 1}}}}).is_null());

  EXPECT_FALSE(Do({{"command", "hands"}, {"count", 2}}).is_null());
  PumpUntil("hands");
  EXPECT_FALSE(Do({{"command", "use"}, {"hand", 1}, {"device", 0}}).is_null());
  PumpUntil("hands");
  EXPECT_FALSE(Do({{"command", "devices"}}).is_null());
  PumpUntil("devices");
  EXPECT_FALSE(Do({{"command", "forces"}, {"off", true}}).is_null());
  EXPECT_FALSE(DoAs("c2", &other_link_, {{"command", "lease"}, {"action", "request"}}).is_null());
  EXPECT_FALSE(Do({{"command", "lease"}, {"action", "give"}, {"to", "c2"}, {"hand", 1}}).is_null());
  EXPECT_FALSE(DoAs("c2", &other_link_, {{"command", "ask_part"}, {"hand", 0}}).is_null());
  EXPECT_FALSE(Do({{"command", "lease"}, {"action", "give"}, {"to", "c2"}}).is_null());
  ASSERT_TRUE(log_.AwaitTrue([this] {
    hub_.PublishStatus();
    return link_.events.count("status") > 0;
  }));
  EXPECT_FALSE(Do({{"command", "status"}}).is_null());
  EXPECT_FALSE(Do({{"command", "introduce"}, {"name", "Ada"}}).is_null());
  const Json eye = Json::array({0, -1, 0.5});
  EXPECT_FALSE(DoAs("c2", &other_link_, {{"command", "look"}, {"eye", eye}, {"target", {0, 0, 0}}})
                   .is_null());
  const Json note{{"command", "add_note"}, {"occurrence", 1}, {"p_B", {0, 0, 0}}, {"text", "Here"}};
  const Json noted = Do(note);
  ASSERT_FALSE(noted.is_null());
  EXPECT_FALSE(Do({{"command", "remove_note"}, {"note", noted["note"]}}).is_null());
  PumpUntil("notes");

  std::set<std::string> events = link_.events;
  // "resumed" is checked with the work that is kept, "study" with its desk, "safety" below;
  // "device" would need one that fails.
  events.insert({"device", "lease_asked", "resumed", "safety", "study"});
  EXPECT_EQ(events, testing::EventNames());
}

TEST_F(ProtocolTest, EveryCommandOfTheSchemaIsKnown) {
  for (const std::string& name : testing::CommandNames()) {
    (void)Do({{"command", name}, {"action", "none"}, {"on", 0}});
    EXPECT_EQ(link_.reply->dump().find("there is no such command"), std::string::npos) << name;
  }
}

TEST(ProtocolOfEvents, SafetyIsAsTheSchemaSays) {
  simulation::SimulationEvent event;
  event.kind = simulation::SimulationEvent::Kind::kSafety;
  event.gate_actions = 3;
  EXPECT_EQ(testing::FindEventFault(ToJson(event)), "");
}

TEST(ProtocolOfEvents, WhatDiffersFromTheSchemaIsNamed) {
  const Json forces{{"event", "forces"}, {"off", true}, {"by", "c1"}};
  EXPECT_EQ(testing::FindEventFault(forces), "");
  Json more = forces;
  more["why"] = "";
  EXPECT_EQ(testing::FindEventFault(more), "forces.why is not in the schema");
  Json less = forces;
  less.erase("by");
  EXPECT_EQ(testing::FindEventFault(less), "forces.by is missing");
  Json other = forces;
  other["off"] = 1;
  EXPECT_EQ(testing::FindEventFault(other), "forces.off is no flag: 1");
  EXPECT_NE(testing::FindEventFault({{"event", "explode"}}), "");
  EXPECT_EQ(testing::FindFault("Pose", {{"p", {1, 2}}, {"q", {1, 0, 0, 0}}}), ".p is no list of 3");
  EXPECT_EQ(testing::FindFault("Placement", "lost").find(" is not 'loose', and"), 0U);
}

}  // namespace
}  // namespace hvas::studio
