#include "studio/hub.h"

#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "studio/test/protocol_schema.h"
#include "studio/test/small_bench.h"

namespace hvas::studio {
namespace {

/** A client that keeps all that it is sent. */
class FakeLink final : public ClientLink {
 public:
  void SendText(std::string text) override {
    texts.push_back(Json::parse(text));
    if (const Json& json = texts.back(); !json.contains("ok")) {
      EXPECT_EQ(testing::FindEventFault(json), "") << json;
    }
  }

  void SendFrames(std::string bytes) override { frames.push_back(std::move(bytes)); }

  void Close(const std::string& why) override { reason = why; }

  /** The newest event of a name; null when there was none. */
  [[nodiscard]] Json Last(const std::string& event) const {
    for (auto it = texts.rbegin(); it != texts.rend(); ++it) {
      if (it->value("event", "") == event) {
        return *it;
      }
    }
    return nullptr;
  }

  std::vector<Json> texts;
  std::vector<std::string> frames;
  std::string reason;
};

/** The bench is asked by the test's thread alone, as by the server's. */
class HubTest : public ::testing::Test {
 protected:
  HubTest()
      : bench_(testing::SmallBench(log_.clock())), hub_(&bench_, {{"peg", "Peg", "", "peg.step"}}) {
    bench_.on_event = [this](Json event) { log_.Add(std::move(event)); };
  }

  void TearDown() override { bench_.Stop(); }

  /** A client of a browser that has not come before. */
  std::string Join(Role role, FakeLink* link) {
    return JoinAs({role, /*is_owner=*/false, ++last_browser_}, link);
  }

  std::string JoinAs(const Visitor& visitor, FakeLink* link) {
    return hub_.Join(visitor, link, now_ns_).value_or("");
  }

  void Leave(const std::string& id) { hub_.Leave(id, now_ns_); }

  /** The reply to a command. */
  Json Ask(const std::string& id, FakeLink* link, Json command) {
    command["id"] = ++last_id_;
    return AskText(id, link, command.dump());
  }

  Json AskText(const std::string& id, FakeLink* link, std::string_view text) {
    link->texts.clear();
    now_ns_ += 1'000'000'000;
    hub_.OnText(id, text, now_ns_);
    for (const Json& json : link->texts) {
      if (json.contains("ok")) {
        return json;
      }
    }
    return nullptr;
  }

  void OpenPeg() {
    bench_.opener().Open("peg.step", "peg");
    ASSERT_TRUE(log_.Await("scene"));
  }

  /** Publishes what is new, as the server does at each frame. */
  void Publish(double seconds) {
    constexpr double kFrame = 0.005;  // More often than there are frames [s].
    for (int frame = 0; frame * kFrame < seconds; ++frame) {
      log_.Pass(kFrame);
      hub_.PublishFrame();
    }
  }

  static protocol::Header HeaderOf(const std::string& bytes) {
    protocol::Header header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    return header;
  }

  void Credit(const std::string& id, std::uint32_t seq) {
    const protocol::Acknowledgement credit{seq};
    std::string bytes;
    AppendFrame<protocol::Acknowledgement>(std::span(&credit, 1), 1, 1, 0, &bytes);
    hub_.OnBinary(id, bytes);
  }

  testing::EventLog log_;
  Workbench bench_;
  Hub hub_;
  std::int64_t now_ns_{1'000'000'000};
  std::uint32_t last_browser_{100};
  int last_id_{0};
};

bool IsError(const Json& reply, const std::string& code) {
  return reply.is_object() && reply["ok"] == false && reply["error"]["code"] == code &&
         !reply["error"]["message"].empty();
}

TEST_F(HubTest, FirstOperatorSteers) {
  FakeLink viewer;
  FakeLink first;
  FakeLink second;
  Join(Role::kViewer, &viewer);
  Join(Role::kOperator, &first);
  Join(Role::kOperator, &second);
  EXPECT_EQ(viewer.Last("hello")["has_lease"], false);
  EXPECT_EQ(first.Last("hello")["has_lease"], true);
  EXPECT_EQ(second.Last("hello")["has_lease"], false);
  EXPECT_EQ(viewer.Last("roles")["clients"].size(), 3u);
  EXPECT_EQ(viewer.Last("hello")["version"], protocol::kVersion);
}

TEST_F(HubTest, WhoeverComesAfterItLearnsThatTheFileCouldNotBeOpened) {
  bench_.opener().Open("missing", "missing.step");
  ASSERT_TRUE(log_.Await("failed"));
  FakeLink late;
  Join(Role::kOperator, &late);
  EXPECT_EQ(late.Last("failed")["file"], "missing.step");
  EXPECT_EQ(late.Last("failed")["error"]["remedy"], "name another");
  OpenPeg();
  FakeLink later;
  Join(Role::kOperator, &later);
  EXPECT_TRUE(later.Last("failed").is_null()) << "something else is open now";
}

TEST_F(HubTest, OnlyWhoeverHasTheLeaseCommands) {  // N11: one operator
  FakeLink first;
  FakeLink second;
  FakeLink viewer;
  Join(Role::kOperator, &first);
  const std::string other = Join(Role::kOperator, &second);
  const std::string looking = Join(Role::kViewer, &viewer);
  for (const char* command :
       {"open", "cancel", "take", "release", "demo", "next", "undo", "redo", "reset", "hands",
        "use", "assign_fit", "add_mate", "remove_mate", "plan_removal", "take_out"}) {
    const Json fields{{"command", command}, {"example", "peg"}, {"on", true}, {"occurrence", 1}};
    EXPECT_TRUE(IsError(Ask(other, &second, fields), "invalid")) << command;
    const Json refused = Ask(looking, &viewer, fields);
    EXPECT_TRUE(IsError(refused, "invalid")) << command;
    EXPECT_FALSE(refused["error"]["remedy"].empty());
  }
  log_.Pass(0.05);
  EXPECT_FALSE(log_.Find([](const Json& e) { return e["event"] == "progress"; }));
}

TEST_F(HubTest, AnybodySwitchesTheForcesOffButOnlyWhoeverSteersSwitchesThemOn) {  // N6
  FakeLink steering;
  FakeLink viewer;
  const std::string hand = Join(Role::kOperator, &steering);
  const std::string looking = Join(Role::kViewer, &viewer);
  EXPECT_TRUE(Ask(looking, &viewer, {{"command", "forces"}, {"off", true}})["ok"]);
  EXPECT_TRUE(bench_.live().forces_off());
  EXPECT_EQ(steering.Last("forces")["off"], true);
  EXPECT_EQ(steering.Last("forces")["by"], looking);
  EXPECT_TRUE(IsError(Ask(looking, &viewer, {{"command", "forces"}, {"off", false}}), "invalid"));
  EXPECT_TRUE(bench_.live().forces_off());
  EXPECT_TRUE(Ask(hand, &steering, {{"command", "forces"}, {"off", false}})["ok"]);
  EXPECT_FALSE(bench_.live().forces_off());
}

TEST_F(HubTest, ForcesAreSwitchedOffHoweverManyCommandsCameBefore) {  // N6
  FakeLink link;
  const std::string id = Join(Role::kViewer, &link);
  for (int i = 0; i < 500; ++i) {
    hub_.OnText(id, R"({"id": 1, "command": "status"})", now_ns_);
  }
  hub_.OnText(id, R"({"id": 2, "command": "forces", "off": true})", now_ns_);
  EXPECT_TRUE(bench_.live().forces_off());
}

TEST_F(HubTest, LeaseIsGivenReleasedAndAskedFor) {
  FakeLink first;
  FakeLink second;
  FakeLink viewer;
  const std::string a = Join(Role::kOperator, &first);
  const std::string b = Join(Role::kOperator, &second);
  const std::string v = Join(Role::kViewer, &viewer);
  const auto lease = [this](const std::string& id, FakeLink* link, Json fields) {
    fields["command"] = "lease";
    return Ask(id, link, fields)["ok"] == true;
  };
  const auto has = [&viewer](const std::string& id) {
    const Json roles = viewer.Last("roles");
    for (const Json& client : roles["clients"]) {
      if (client["id"] == id) {
        return client["has_lease"] == true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has(a));
  EXPECT_TRUE(lease(b, &second, {{"action", "request"}}));  // asks, and waits
  EXPECT_EQ(first.Last("lease_asked")["by"], b);
  EXPECT_TRUE(has(a));
  EXPECT_FALSE(lease(b, &second, {{"action", "release"}}));  // has none
  EXPECT_FALSE(lease(b, &second, {{"action", "give"}, {"to", b}}));
  EXPECT_FALSE(lease(a, &first, {{"action", "give"}, {"to", v}}));  // a viewer
  EXPECT_FALSE(lease(a, &first, {{"action", "give"}, {"to", "c99"}}));
  EXPECT_FALSE(lease(a, &first, {{"action", "give"}}));
  EXPECT_TRUE(lease(a, &first, {{"action", "give"}, {"to", b}}));
  EXPECT_TRUE(has(b));
  EXPECT_FALSE(has(a));
  EXPECT_TRUE(lease(b, &second, {{"action", "release"}}));
  EXPECT_FALSE(has(b));
  EXPECT_FALSE(lease(v, &viewer, {{"action", "request"}}));
  EXPECT_TRUE(lease(a, &first, {{"action", "request"}}));
  EXPECT_TRUE(has(a));
}

TEST_F(HubTest, LeaseWaitsForTheBrowserThatHasLostItAndIsFreeThen) {
  FakeLink first;
  FakeLink second;
  const Visitor holder{Role::kOperator, false, 1};
  const std::string a = JoinAs(holder, &first);
  const std::string b = Join(Role::kOperator, &second);
  const Json request{{"command", "lease"}, {"action", "request"}};
  Leave(a);
  EXPECT_EQ(second.Last("roles")["clients"].size(), 1u);
  const Json refused = Ask(b, &second, request);
  EXPECT_TRUE(IsError(refused, "invalid"));
  EXPECT_EQ(refused["error"]["remedy"], "ask again in 29 s");
  FakeLink third;
  Join(Role::kOperator, &third);
  EXPECT_EQ(third.Last("hello")["has_lease"], false) << "nor has it who comes meanwhile";
  FakeLink again;
  const std::string back = JoinAs(holder, &again);
  EXPECT_EQ(again.Last("hello")["has_lease"], true);
  Leave(back);
  now_ns_ += HandLeases::kWaitNs;
  EXPECT_TRUE(Ask(b, &second, request)["ok"]);
  EXPECT_EQ(second.Last("roles")["clients"][0]["has_lease"], true);
}

TEST_F(HubTest, LeaseThatWasReleasedWaitsForNobody) {
  FakeLink first;
  FakeLink second;
  const std::string a = Join(Role::kOperator, &first);
  const std::string b = Join(Role::kOperator, &second);
  EXPECT_TRUE(Ask(a, &first, {{"command", "lease"}, {"action", "release"}})["ok"]);
  Leave(a);
  EXPECT_TRUE(Ask(b, &second, {{"command", "lease"}, {"action", "request"}})["ok"]);
  EXPECT_EQ(second.Last("roles")["clients"][0]["has_lease"], true);
}

TEST_F(HubTest, OwnerTakesEveryHandBackAtOnce) {
  const Visitor owner{Role::kOperator, true, 1};
  FakeLink first;
  FakeLink guest;
  const std::string a = JoinAs(owner, &first);
  const std::string b = Join(Role::kOperator, &guest);
  const Json request{{"command", "lease"}, {"action", "request"}};
  EXPECT_TRUE(Ask(a, &first, {{"command", "lease"}, {"action", "give"}, {"to", b}})["ok"]);
  const Json taken = Ask(a, &first, request);
  EXPECT_TRUE(taken["ok"]);
  EXPECT_FALSE(taken["result"].contains("waits_for"));
  EXPECT_EQ(first.Last("roles")["clients"][0]["hands"].size(), 8u);
  // After the lease has waited long enough a guest has it, until the owner is back.
  Leave(a);
  now_ns_ += HandLeases::kWaitNs;
  EXPECT_TRUE(Ask(b, &guest, request)["ok"]);
  FakeLink again;
  const std::string back = JoinAs(owner, &again);
  EXPECT_EQ(again.Last("hello")["is_owner"], true);
  EXPECT_EQ(again.Last("hello")["has_lease"], false);
  EXPECT_TRUE(Ask(back, &again, request)["ok"]);
  EXPECT_EQ(again.Last("roles")["clients"][1]["has_lease"], true);
  EXPECT_EQ(Ask(b, &guest, request)["result"]["waits_for"], back) << "a guest has to ask";
}

TEST_F(HubTest, PagesOfTheOwnerAskEachOther) {
  const Visitor owner{Role::kOperator, true, 1};
  FakeLink first;
  FakeLink second;
  const std::string a = JoinAs(owner, &first);
  const std::string b = JoinAs(owner, &second);
  const Json reply = Ask(b, &second, {{"command", "lease"}, {"action", "request"}});
  EXPECT_EQ(reply["result"]["waits_for"], a);
  EXPECT_EQ(first.Last("lease_asked")["by"], b);
}

TEST_F(HubTest, RecordingsAreTheOwnersWhoeverHasTheLease) {
  FakeLink guest;
  const std::string b = Join(Role::kOperator, &guest);
  EXPECT_EQ(guest.Last("hello")["has_lease"], true);
  for (const Json& command :
       {Json{{"command", "delete_recording"}, {"recording", "x"}},
        Json{{"command", "rename_recording"}, {"recording", "x"}, {"name", "y"}},
        Json{{"command", "share_recording"}, {"recording", "x"}, {"shared", true}}}) {
    const Json refused = Ask(b, &guest, command);
    EXPECT_TRUE(IsError(refused, "invalid")) << command;
    EXPECT_EQ(refused["error"]["remedy"], "ask the user who started this studio");
  }
  FakeLink first;
  const std::string a = JoinAs({Role::kOperator, true, 1}, &first);
  // It is not refused: what the disk says follows as the event "reply".
  EXPECT_TRUE(Ask(a, &first, {{"command", "delete_recording"}, {"recording", "x"}}).is_null());
  const auto told = log_.Await("reply");
  ASSERT_TRUE(told);
  EXPECT_TRUE(IsError((*told)["reply"], "not-found"));
}

TEST_F(HubTest, DeviceIsAnIndexOfTheHostsListAndEveryOtherOneIsAnsweredAlike) {
  FakeLink link;
  const std::string a = JoinAs({Role::kOperator, true, 1}, &link);
  const auto use = [&](const Json& device) {
    return Ask(a, &link, {{"command", "use"}, {"device", device}})["error"];
  };
  const Json missing = use(100);
  EXPECT_EQ(missing["code"], "not-found");
  EXPECT_EQ(use(1000), missing);
  EXPECT_EQ(use(4294967294), missing);
  // An address is none, whether there is such a file or not.
  const Json malformed = use("plugin:/proc/self/exe");
  EXPECT_EQ(malformed["code"], "invalid");
  for (const Json& other : {Json("plugin:/no/such/file"), Json("pointer"), Json("network:0.0.0.0"),
                            Json(-1), Json(0.5), Json(nullptr), Json::array({0})}) {
    EXPECT_EQ(use(other), malformed) << other;
  }
}

TEST_F(HubTest, TwoOperatorsHaveOneHandEach) {  // N11
  OpenPeg();
  FakeLink first;
  FakeLink second;
  const std::string a = Join(Role::kOperator, &first);
  const std::string b = Join(Role::kOperator, &second);
  const auto ask = [this](const std::string& id, FakeLink* link, const char* command, Json fields) {
    fields["command"] = command;
    return Ask(id, link, fields);
  };
  EXPECT_EQ(first.Last("hello")["hands"].size(), 1u);
  const std::size_t start = log_.size();
  EXPECT_TRUE(IsError(ask(b, &second, "hands", {{"count", 2}}), "invalid"));
  EXPECT_EQ(ask(a, &first, "hands", {{"count", 2}})["ok"], true);
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "hands" && e["hands"].size() == 2; }, start));
  EXPECT_EQ(ask(a, &first, "lease", {{"action", "give"}, {"to", b}, {"hand", 1}})["ok"], true);
  const Json clients = second.Last("roles")["clients"];
  EXPECT_EQ(clients[0]["hands"], Json::array({0, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(clients[1]["hands"], Json::array({1}));
  EXPECT_EQ(clients[1]["has_lease"], false);
  // Each commands the own hand only, and the second one nothing else.
  EXPECT_TRUE(IsError(ask(b, &second, "take", {{"hand", 0}, {"occurrence", 1}}), "invalid"));
  EXPECT_TRUE(IsError(ask(a, &first, "take", {{"hand", 1}, {"occurrence", 1}}), "invalid"));
  EXPECT_TRUE(IsError(ask(b, &second, "reset", {}), "invalid"));
  // A part is asked of whoever leads the hand that holds it.
  EXPECT_EQ(ask(b, &second, "ask_part", {{"hand", 0}})["ok"], true);
  EXPECT_EQ(first.Last("part_asked")["by"], b);
  EXPECT_EQ(first.Last("part_asked")["to"], 1);
  EXPECT_TRUE(second.Last("part_asked").is_null());
  EXPECT_TRUE(IsError(ask(b, &second, "hand_over", {{"hand", 0}, {"to", 1}}), "invalid"));
  EXPECT_TRUE(IsError(ask(a, &first, "hand_over", {{"hand", 0}, {"to", 1}}), "invalid"));
  FakeLink viewer;
  const std::string v = Join(Role::kViewer, &viewer);
  EXPECT_TRUE(IsError(ask(v, &viewer, "ask_part", {{"hand", 0}}), "invalid"));
  Leave(v);
  EXPECT_EQ(ask(b, &second, "take", {{"hand", 1}, {"occurrence", 1}})["ok"], true);
  Leave(a);
  now_ns_ += HandLeases::kWaitNs;
  EXPECT_EQ(ask(b, &second, "lease", {{"action", "request"}})["ok"], true);
  EXPECT_EQ(second.Last("roles")["clients"][0]["hands"], Json::array({0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(HubTest, ThreeHandsTakeAPartEachAndANinthIsRefused) {
  OpenPeg();
  FakeLink first;
  const std::string a = Join(Role::kOperator, &first);
  const auto hands = [&](int count) {
    return Ask(a, &first, {{"command", "hands"}, {"count", count}});
  };
  EXPECT_TRUE(IsError(hands(0), "invalid"));
  EXPECT_TRUE(IsError(hands(9), "invalid"));
  const std::size_t start = log_.size();
  EXPECT_EQ(hands(3)["ok"], true);
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "hands" && e["hands"].size() == 3; }, start));
  FakeLink second;
  const std::string b = Join(Role::kOperator, &second);
  EXPECT_EQ(
      Ask(a, &first, {{"command", "lease"}, {"action", "give"}, {"to", b}, {"hand", 2}})["ok"],
      true);
  // Control is that of whoever leads hand 0; the third hand stays with whom it was given to.
  FakeLink third;
  const std::string c = Join(Role::kOperator, &third);
  const Json reply = Ask(c, &third, {{"command", "lease"}, {"action", "request"}});
  EXPECT_EQ(reply["result"]["waits_for"], a);
  EXPECT_EQ(first.Last("lease_asked")["hands"], Json::array({0, 1, 3, 4, 5, 6, 7}));
  EXPECT_EQ(Ask(b, &second, {{"command", "take"}, {"hand", 2}, {"occurrence", 1}})["ok"], true);
  EXPECT_TRUE(log_.Await([](const Json& e) { return e["event"] == "taken" && e["hand"] == 2; }));
}

TEST_F(HubTest, OthersSeeNamesAndWhatIsLookedAt) {
  FakeLink first;
  FakeLink second;
  const std::string a = Join(Role::kOperator, &first);
  const std::string b = Join(Role::kViewer, &second);
  EXPECT_EQ(
      Ask(a, &first, {{"command", "introduce"}, {"name", "  A\u202eda\n<b>Byron\x7f "}})["ok"],
      true);
  EXPECT_EQ(second.Last("roles")["clients"][0]["name"], "Ada <b>Byron");
  EXPECT_TRUE(IsError(Ask(a, &first, {{"command", "introduce"}, {"name", std::string(41, 'x')}}),
                      "invalid"));
  // The limit is of characters, of which some take more than a byte.
  std::string long_name;
  for (int i = 0; i < 40; ++i) {
    long_name += "\u00fc";
  }
  EXPECT_EQ(Ask(a, &first, {{"command", "introduce"}, {"name", long_name}})["ok"], true);
  EXPECT_EQ(second.Last("roles")["clients"][0]["name"], long_name);
  EXPECT_TRUE(IsError(Ask(a, &first, {{"command", "introduce"}, {"name", long_name + "\u00fc"}}),
                      "invalid"));
  const Json look{{"command", "look"}, {"eye", {0, -1, 0.5}}, {"target", {0, 0, 0}}};
  EXPECT_EQ(Ask(b, &second, look)["ok"], true);
  EXPECT_EQ(first.Last("looking")["client"], b);
  EXPECT_TRUE(first.Last("looking")["p_m"].is_null());
  EXPECT_TRUE(second.Last("looking").is_null()) << "who looks knows";
  for (const Json& bad : {Json(nullptr), Json::array({0, 1}), Json::array({0, 1, "x"}),
                          Json::array({0, 1, 1e7}), Json::array({0, 1, nullptr})}) {
    Json wrong = look;
    wrong["eye"] = bad;
    EXPECT_TRUE(IsError(Ask(b, &second, wrong), "invalid")) << bad;
  }
}

TEST_F(HubTest, NotesArePinnedToPartsAndSeenByAll) {
  OpenPeg();
  FakeLink first;
  FakeLink viewer;
  const std::string a = Join(Role::kOperator, &first);
  const std::string v = Join(Role::kViewer, &viewer);
  const auto add = [&](const std::string& by, FakeLink* link, Json occurrence, const char* text) {
    return Ask(by, link,
               {{"command", "add_note"},
                {"occurrence", occurrence},
                {"p_B", {0, 0, 0.01}},
                {"text", text}});
  };
  const std::size_t start = log_.size();
  const Json reply = add(a, &first, 1, "Deburr this edge");
  ASSERT_EQ(reply["ok"], true);
  const auto told = log_.Await([](const Json& e) { return e["event"] == "notes"; }, start);
  ASSERT_TRUE(told);
  ASSERT_EQ((*told)["notes"].size(), 1u);
  EXPECT_EQ((*told)["notes"][0]["text"], "Deburr this edge");
  EXPECT_EQ((*told)["notes"][0]["by"], a);
  EXPECT_TRUE(IsError(add(v, &viewer, 1, "a viewer's"), "invalid"));
  EXPECT_TRUE(IsError(add(a, &first, 99, "no part"), "not-found"));
  EXPECT_TRUE(IsError(add(a, &first, 1, " \t "), "invalid"));
  EXPECT_TRUE(IsError(Ask(a, &first, {{"command", "remove_note"}, {"note", "n99"}}), "not-found"));
  const Json id = reply["result"]["note"];
  EXPECT_EQ(Ask(a, &first, {{"command", "remove_note"}, {"note", id}})["ok"], true);
  EXPECT_TRUE(bench_.notes().List().empty());
  for (std::size_t i = 0; i < WorkbenchNotes::kMaxNotes; ++i) {
    ASSERT_TRUE(bench_.notes().Add({"c1", "more", product::OccurrenceId(0), Vec3::Zero()}));
  }
  EXPECT_TRUE(IsError(add(a, &first, 1, "too many"), "out-of-resource"));
}

TEST_F(HubTest, PagesOfALinkAreLimitedAndPlacesAreKeptForTheOwner) {
  std::vector<FakeLink> links(Hub::kMaxClients + 2);
  std::size_t count = 0;
  const auto fill = [&](const Visitor& visitor) {
    std::size_t joined = 0;
    while (const auto id = hub_.Join(visitor, &links[count], now_ns_)) {
      ++count;
      ++joined;
    }
    EXPECT_TRUE(links[count].texts.empty()) << "who is refused is told nothing";
    return joined;
  };
  EXPECT_EQ(fill({Role::kViewer, false, 1}), Hub::kMaxViewingClients);
  EXPECT_EQ(fill({Role::kViewer, false, 2}), 0u) << "all viewers have one link";
  EXPECT_EQ(fill({Role::kOperator, false, 3}), Hub::kMaxClientsOfLink);
  EXPECT_EQ(fill({Role::kOperator, false, 4}), Hub::kMaxClientsOfLink);
  EXPECT_EQ(fill({Role::kOperator, false, 5}), 0u);
  EXPECT_EQ(fill({Role::kOperator, true, 6}), Hub::kKeptForOwner);
  EXPECT_EQ(count, Hub::kMaxClients);
  const auto refused = hub_.Join({Role::kViewer, false, 1}, &links[count], now_ns_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kOutOfResource);
  Leave("c1");
  EXPECT_EQ(fill({Role::kViewer, false, 1}), 1u);
}

TEST_F(HubTest, UnknownCommandIsAnsweredWithAnError) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  EXPECT_TRUE(IsError(Ask(id, &link, {{"command", "explode"}}), "not-found"));
  EXPECT_TRUE(IsError(Ask(id, &link, {{"command", ""}}), "not-found"));
  EXPECT_TRUE(IsError(Ask(id, &link, Json::object()), "invalid"));
}

TEST_F(HubTest, TextsThatAreNoCommandsAreAnsweredWithAnError) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const std::string deep(60'000, '[');
  const std::string deep_object = [] {
    std::string text;
    for (int i = 0; i < 10'000; ++i) {
      text += "{\"a\":";
    }
    return text + "1" + std::string(10'000, '}');
  }();
  for (const std::string& text :
       {std::string(), std::string("x"), std::string("null"), std::string("[]"), std::string("5"),
        std::string("{"), std::string("\xFF\xFE"), std::string(60'000, ' '), deep,
        deep + std::string(60'000, ']'), deep_object, std::string("{\"id\": 1}"),
        std::string("{\"id\": 1, \"command\": 5}"), std::string("{\"id\": 1, \"command\": null}"),
        std::string("{\"id\": 1, \"command\": [\"open\"]}"),
        "{\"id\": 1, \"command\": \"" + std::string(60'000, 'a') + "\"}"}) {
    const Json reply = AskText(id, &link, text);
    EXPECT_EQ(reply["ok"], false) << text.substr(0, 40);
    EXPECT_FALSE(reply["error"]["message"].empty());
  }
}

TEST_F(HubTest, CommandsOfMoreFieldsThanAnyHasAreRefused) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const auto command_with = [](int more) {
    std::string text = R"({"id": 1, "command": "status")";
    for (int i = 0; i < more; ++i) {
      text += ",\"" + std::to_string(i) + "\":0";
    }
    return text + "}";
  };
  EXPECT_EQ(AskText(id, &link, command_with(62))["ok"], true);
  EXPECT_TRUE(IsError(AskText(id, &link, command_with(63)), "invalid"));
  EXPECT_TRUE(IsError(AskText(id, &link, command_with(7000)), "invalid"));  // 64 KiB
  // In whatever they are.
  EXPECT_TRUE(IsError(AskText(id, &link,
                              R"({"id": 1, "command": "status", "a": [)" + command_with(31) + "," +
                                  command_with(31) + "]}"),
                      "invalid"));
}

TEST_F(HubTest, FieldsOfTheWrongTypeAreNamed) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const auto names = [&](Json command, const char* field) {
    const Json reply = Ask(id, &link, std::move(command));
    return IsError(reply, "invalid") &&
           reply["error"]["message"].get<std::string>().find(field) != std::string::npos;
  };
  EXPECT_TRUE(names({{"command", "take"}}, "occurrence"));
  for (const Json& bad : {Json(-1), Json(0.5), Json("1"), Json(4294967295U), Json(1e300),
                          Json(nullptr), Json::array({1}), Json(true)}) {
    EXPECT_TRUE(names({{"command", "take"}, {"occurrence", bad}}, "occurrence")) << bad;
  }
  EXPECT_TRUE(names({{"command", "take"}, {"hand", 8}, {"occurrence", 1}}, "hand"));
  EXPECT_TRUE(names({{"command", "release"}, {"hand", "left"}}, "hand"));
  EXPECT_TRUE(names({{"command", "use"}, {"hand", 0}}, "device"));
  for (const Json& bad : {Json(-1), Json(1e300), Json("1"), Json(nullptr)}) {
    EXPECT_TRUE(names({{"command", "use"}, {"device", 1}, {"scale", bad}}, "scale")) << bad;
  }
  EXPECT_TRUE(names({{"command", "hands"}}, "count"));
  EXPECT_TRUE(names({{"command", "forces"}, {"off", "yes"}}, "off"));
  EXPECT_TRUE(names({{"command", "forces"}}, "off"));
  EXPECT_TRUE(names({{"command", "demo"}, {"on", 1}}, "on"));
  EXPECT_TRUE(names({{"command", "assign_fit"}, {"mate", 0}, {"fit", 7}}, "fit"));
  EXPECT_TRUE(names({{"command", "open"}, {"upload", 7}}, "upload"));
  EXPECT_TRUE(names({{"command", "lease"}, {"action", Json::object()}}, "action"));
}

TEST_F(HubTest, ReplyHasTheIdOfItsCommand) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  EXPECT_EQ(AskText(id, &link, R"({"id": 77, "command": "status"})")["id"], 77);
  EXPECT_EQ(AskText(id, &link, R"({"id": -5, "command": "status"})")["id"], -5);
  EXPECT_EQ(AskText(id, &link, R"({"id": {"a": 1}, "command": "status"})")["id"], nullptr);
  EXPECT_EQ(AskText(id, &link, R"({"command": "status"})")["id"], nullptr);
}

TEST_F(HubTest, TooManyCommandsASecondAreRefusedUntilTimePasses) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const auto count_obeyed = [&](int sent) {
    link.texts.clear();
    for (int i = 0; i < sent; ++i) {
      hub_.OnText(id, R"({"id": 1, "command": "status"})", now_ns_);
    }
    return std::count_if(link.texts.begin(), link.texts.end(),
                         [](const Json& json) { return json.value("ok", false); });
  };
  EXPECT_EQ(count_obeyed(300), static_cast<int>(Hub::kCommandBurst));
  EXPECT_TRUE(IsError(link.texts.back(), "out-of-resource"));
  now_ns_ += 1'000'000'000;
  EXPECT_EQ(count_obeyed(300), static_cast<int>(Hub::kCommandsPerSecond));
  FakeLink other;  // each has its own
  const std::string calm = Join(Role::kViewer, &other);
  hub_.OnText(calm, R"({"id": 1, "command": "status"})", now_ns_);
  EXPECT_EQ(other.texts.back()["ok"], true);
}

TEST_F(HubTest, CommandsWithoutAProductSayWhatToDo) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const Json face{{"occurrence", 0}, {"face", 0}};
  for (Json command :
       {Json{{"command", "take"}, {"occurrence", 0}}, Json{{"command", "release"}},
        Json{{"command", "demo"}, {"on", true}}, Json{{"command", "next"}},
        Json{{"command", "undo"}}, Json{{"command", "redo"}}, Json{{"command", "reset"}},
        Json{{"command", "plan_removal"}, {"occurrence", 1}},
        Json{{"command", "take_out"}, {"occurrence", 1}},
        Json{{"command", "assign_fit"}, {"mate", 0}, {"fit", "H7/g6"}},
        Json{{"command", "add_mate"}, {"a", face}, {"b", face}},
        Json{{"command", "remove_mate"}, {"mate", 0}}, Json{{"command", "measure"}, {"a", face}}}) {
    const std::string name = command["command"];
    const Json reply = Ask(id, &link, std::move(command));
    EXPECT_TRUE(IsError(reply, "not-found")) << name;
    EXPECT_FALSE(reply["error"]["remedy"].empty()) << name;
  }
  EXPECT_TRUE(IsError(Ask(id, &link, {{"command", "open"}, {"example", "x"}}), "not-found"));
  EXPECT_TRUE(IsError(Ask(id, &link, {{"command", "open"}, {"upload", "x"}}), "not-found"));
  hub_.PublishFrame();
  EXPECT_TRUE(link.frames.empty());
}

TEST_F(HubTest, CommandsOnPartsThatAreNotThereAreErrors) {
  OpenPeg();
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  const Json face{{"occurrence", 0}, {"face", 0}};
  const Json none{{"occurrence", 99}, {"face", 0}};
  const Json no_face{{"occurrence", 0}, {"face", 999}};
  for (const Json& command :
       {Json{{"command", "take"}, {"occurrence", 99}},
        Json{{"command", "assign_fit"}, {"mate", 99}, {"fit", "H7/g6"}},
        Json{{"command", "assign_fit"}, {"mate", 0}, {"fit", "nonsense"}},
        Json{{"command", "remove_mate"}, {"mate", 99}}, Json{{"command", "measure"}, {"a", none}},
        Json{{"command", "measure"}, {"a", no_face}},
        Json{{"command", "measure"}, {"a", face}, {"b", none}},
        Json{{"command", "add_mate"}, {"a", face}, {"b", none}},
        Json{{"command", "add_mate"}, {"a", no_face}, {"b", face}}}) {
    EXPECT_EQ(Ask(id, &link, command)["ok"], false) << command;
  }
  EXPECT_TRUE(Ask(id, &link, {{"command", "measure"}, {"a", face}})["ok"]);
}

TEST_F(HubTest, AtMostSoManyFrameMessagesWaitToBeSeen) {
  OpenPeg();
  FakeLink link;
  const std::string id = Join(Role::kViewer, &link);
  Publish(0.5);
  ASSERT_EQ(link.frames.size(), Hub::kMaxUnseen);
  const protocol::Header first = HeaderOf(link.frames[0]);
  EXPECT_EQ(first.kind, static_cast<std::uint16_t>(protocol::FrameKind::kPoses));
  EXPECT_EQ(first.count, 2u);  // the first message has all parts
  EXPECT_EQ(first.epoch, 1u);
  Publish(0.2);
  ASSERT_EQ(link.frames.size(), Hub::kMaxUnseen);
  Credit(id, HeaderOf(link.frames[Hub::kMaxUnseen - 1]).seq);
  ASSERT_EQ(link.frames.size(), Hub::kMaxUnseen + 1);  // at once
  const protocol::Header newest = HeaderOf(link.frames[Hub::kMaxUnseen]);
  EXPECT_EQ(newest.t_ns, bench_.live().frame().clock_ns);  // not what was missed
  EXPECT_LT(newest.count, 2u);                             // the block stands in its fixture
}

TEST_F(HubTest, CreditForWhatWasNeverSentIsWorthNothing) {
  OpenPeg();
  FakeLink link;
  const std::string id = Join(Role::kViewer, &link);
  Publish(0.5);
  ASSERT_EQ(link.frames.size(), Hub::kMaxUnseen);
  Credit(id, 4'000'000'000U);
  Publish(0.3);
  EXPECT_LE(link.frames.size(), 2 * Hub::kMaxUnseen);
  Credit(id, 1);  // from the past
  Publish(0.2);
  EXPECT_LE(link.frames.size(), 2 * Hub::kMaxUnseen);
}

TEST_F(HubTest, FramesThatAreNoneEndTheClient) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  hub_.OnBinary(id, "nonsense");
  EXPECT_FALSE(link.reason.empty());
}

TEST_F(HubTest, WhoeverHasLeftIsNotHeard) {
  FakeLink link;
  const std::string id = Join(Role::kOperator, &link);
  Leave(id);
  link.texts.clear();
  hub_.OnText(id, R"({"id": 1, "command": "forces", "off": true})", now_ns_);
  hub_.OnBinary(id, "nonsense");
  Leave(id);
  EXPECT_TRUE(link.texts.empty());
  EXPECT_TRUE(link.reason.empty());
  EXPECT_FALSE(bench_.live().forces_off());
}

}  // namespace
}  // namespace hvas::studio
