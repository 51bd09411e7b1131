// Every command, every field and every route, with values that an attacker would send, by each role
// of docs/access.md, through a real socket: no path of the host, nothing of other products, no
// code, and nobody is locked out. A new command or field is attacked as soon as it is in
// protocol.json.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record/recorder.h"
#include "studio/recording.h"
#include "studio/test/protocol_schema.h"
#include "studio/test/server_fixture.h"
#include "study/protocol.h"
#include "study/study_folder.h"

namespace hvas::studio {
namespace {

using testing::CommandExample;
using testing::Headers;
using testing::Message;
using testing::RawClient;
using testing::Reply;
using testing::ServerTest;

constexpr const char* kForeign = "foreign";  // A recording of a product that is not open.

/** JSON texts to put in place of a field. */
std::vector<std::string> MakeHostileValues() {
  std::vector<std::string> values{R"("/etc/passwd")",
                                  R"("../../../../../../etc/passwd")",
                                  R"("plugin:/proc/self/exe")",
                                  R"("/proc/self/fd/3")",
                                  R"("file:///etc/passwd")",
                                  R"("network:0.0.0.0:0")",
                                  R"("\\\\host\\share")",
                                  R"("a\u0000b")",
                                  R"("\r\nSet-Cookie: a=b")",
                                  "\"foreign\"",
                                  "4294967294",
                                  "4294967295",
                                  "1e9",
                                  "18446744073709551616",
                                  "-1",
                                  "0.5",
                                  "1e308",
                                  "-1e308",
                                  "1e999",
                                  "NaN",
                                  "Infinity",
                                  "true",
                                  "null",
                                  "[]",
                                  "{}",
                                  R"([[[[{"a": [null]}]]]])",
                                  R"({"__proto__": 1})",
                                  "\"\""};
  values.push_back("\"" + std::string(50'000, 'a') + "\"");
  values.push_back(std::string(20'000, '[') + std::string(20'000, ']'));
  return values;
}

/** What all attackers have. */
class AttackTest : public ServerTest {
 protected:
  AttackTest() : recordings_(testing::SmallBench().recordings_folder) {}

  /** The Cookie header of a browser that the owner has invited. */
  std::string Invite(const std::string& role) {
    const Reply made =
        Post("/api/link", Json{{"role", role}}.dump(), {{"Cookie", CookieOf(Role::kOperator)}});
    EXPECT_EQ(made.status, 200);
    const std::string given =
        GiveToken(Json::parse(made.body)["token"].get<std::string>()).headers["set-cookie"];
    return given.substr(0, given.find(';'));
  }

  std::unique_ptr<RawClient> JoinWith(const std::string& cookie) const {
    auto client = Connect();
    client->SendUpgrade({{"Host", host()}, {"Origin", origin()}, {"Cookie", cookie}});
    EXPECT_EQ(client->ReadReply().status, 101);
    return client;
  }

  /** Nothing that a client gets names a folder of this machine or another product. */
  void CheckText(const std::string& text, const std::string& sent) const {
    for (const std::string& secret :
         {folder_.string(), recordings_.string(), std::filesystem::current_path().string(),
          std::string(HVAS_SOURCE_DIR), std::string("secret product"), std::string("root:x:"),
          std::string("No such file"), std::string("cannot open shared object")}) {
      EXPECT_EQ(text.find(secret), std::string::npos)
          << sent.substr(0, 200) << "\n-> " << text.substr(0, 500);
    }
  }

  /** The id of an answer; the largest number for none, as of what is no JSON. */
  static std::size_t IdOf(const Json& reply) {
    const auto id = reply.find("id");
    return id != reply.end() && id->is_number_unsigned() ? id->get<std::size_t>() : SIZE_MAX;
  }

  /** A command of the schema with a hostile value in one of its fields. */
  struct Attack {
    std::string name;  ///< Command, or action of a study.
    std::string rest;  ///< JSON of the message from behind its id to its end.
  };

  using Prepare = std::function<void(RawClient* client)>;

  /** Sends attacks by one browser, in as many connections as the limit of a connection's commands
   needs, so that each is read. @param prepare  Called with each connection that has joined.
   @returns the names of those that were obeyed. */
  std::set<std::string> SendAll(const std::string& cookie, const std::vector<Attack>& attacks,
                                const Prepare& prepare = {}) {
    std::set<std::string> obeyed;
    for (std::size_t begin = 0; begin < attacks.size();) {
      const auto client = JoinWith(cookie);
      if (prepare) {
        prepare(client.get());
      }
      std::size_t end = begin;
      for (double cost = 1; end < attacks.size(); ++end) {  // One is for the last command.
        const std::string text = "{\"id\":" + std::to_string(end) + attacks[end].rest;
        cost += std::max(1.0, static_cast<double>(text.size()) / Hub::kBytesOfCommand);
        if (cost > Hub::kCommandBurst && end > begin) {
          break;
        }
        EXPECT_TRUE(client->SendMessage(Message::kText, text));
      }
      client->SendMessage(Message::kText,
                          Json{{"id", attacks.size()}, {"command", "status"}}.dump());
      const Json last = Await(client.get(), [&](const Json& json) {
        const std::size_t i = IdOf(json);
        CheckText(json.dump(), i < attacks.size() ? attacks[i].rest : "");
        EXPECT_EQ(json.dump().find("too many commands"), std::string::npos);
        if (json.value("ok", false) && i < attacks.size()) {
          obeyed.insert(attacks[i].name);
        }
        return i == attacks.size();
      });
      EXPECT_FALSE(last.is_null()) << "the connection ended after " << attacks[begin].rest;
      begin = end;
    }
    return obeyed;
  }

  /** All attacks on all commands. */
  static std::vector<Attack> MakeAttacks() {
    std::vector<Attack> attacks;
    for (const CommandExample& example : testing::MakeCommandExamples()) {
      attacks.push_back({example.name, "," + example.message.dump().substr(1)});
      for (const std::string& field : example.fields) {
        Json others = example.message;
        others.erase(field);
        for (const std::string& value : MakeHostileValues()) {
          std::string rest = "," + others.dump().substr(1);
          rest.insert(rest.size() - 1, "," + Json(field).dump() + ":" + value);
          attacks.push_back({example.name, std::move(rest)});
        }
      }
    }
    return attacks;
  }

  /** The open product is still there, and the owner, a viewer and the forces work. */
  void CheckAllIsWell() {
    EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
    const auto viewer = Join(Role::kViewer);
    EXPECT_TRUE(AwaitEvent(viewer.get(), "hello")["has_scene"]);
    EXPECT_TRUE(Command(viewer.get(), {{"id", 1}, {"command", "forces"}, {"off", true}})["ok"]);
    EXPECT_TRUE(bench_->live().forces_off());
    EXPECT_TRUE(Command(owner_.get(), {{"id", 1}, {"command", "forces"}, {"off", false}})["ok"]);
    EXPECT_TRUE(std::filesystem::exists(recordings_ / (std::string(kForeign) + ".hvasrec")));
  }

  std::filesystem::path recordings_;
  std::unique_ptr<RawClient> owner_;
  std::string guest_cookie_;
};

/** A server with an open product, and a recording of another one. */
class ServerAttackTest : public AttackTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    record::RecorderOptions options;
    options.path = recordings_ / (std::string(kForeign) + ".hvasrec");
    std::filesystem::create_directories(recordings_);
    auto recorder = record::Recorder::Create(
        options, {{"product", "secret product"}, {kProductDigestMeta, "another"}});
    ASSERT_TRUE(recorder.has_value()) << recorder.error().ToString();
    (*recorder)->AddTick({});
    ASSERT_TRUE((*recorder)->Finish().has_value());
    // All of them come once, so that a later connection finds its session.
    owner_ = JoinAndOpen();
    guest_cookie_ = Invite("operator");
  }

  void TearDown() override {
    ServerTest::TearDown();
    std::filesystem::remove(recordings_ / (std::string(kForeign) + ".hvasrec"));
  }
};

TEST_F(ServerAttackTest, ViewerIsObeyedInNothingThatChangesTheWork) {
  std::set<std::string> allowed;
  for (const CommandExample& example : testing::MakeCommandExamples()) {
    if (example.right == "anybody") {
      allowed.insert(example.name);
    }
  }
  for (const std::string& name : SendAll(CookieOf(Role::kViewer), MakeAttacks())) {
    EXPECT_TRUE(allowed.count(name) > 0) << name;
  }
  CheckAllIsWell();
}

TEST_F(ServerAttackTest, GuestWithoutALeaseIsObeyedInNothingThatNeedsOne) {
  std::set<std::string> allowed;
  for (const CommandExample& example : testing::MakeCommandExamples()) {
    if (example.right == "anybody" || example.right == "operator") {
      allowed.insert(example.name);
    }
  }
  for (const std::string& name : SendAll(guest_cookie_, MakeAttacks())) {
    EXPECT_TRUE(allowed.count(name) > 0) << name;
  }
  CheckAllIsWell();
}

TEST_F(ServerAttackTest, GuestWithTheLeaseDoesNothingThatIsTheOwners) {
  std::set<std::string> owners;
  for (const CommandExample& example : testing::MakeCommandExamples()) {
    if (example.right == "owner") {
      owners.insert(example.name);
    }
  }
  ASSERT_FALSE(owners.empty());
  std::vector<Attack> attacks = MakeAttacks();
  // What sends its lease away, or ends what the test looks at, is tried by the others.
  std::erase_if(attacks, [&owners](const Attack& attack) {
    return attack.name != "use" && attack.name != "open" && owners.count(attack.name) == 0;
  });
  const auto give_lease = [this](RawClient* guest) {
    const Json hello = AwaitEvent(guest, "hello");
    const Json request{{"id", 1}, {"command", "lease"}, {"action", "request"}};
    EXPECT_TRUE(Command(owner_.get(), request)["ok"]);
    const Json give{{"id", 2}, {"command", "lease"}, {"action", "give"}, {"to", hello["client"]}};
    EXPECT_TRUE(Command(owner_.get(), give)["ok"]);
  };
  for (const std::string& name : SendAll(guest_cookie_, attacks, give_lease)) {
    EXPECT_EQ(owners.count(name), 0u) << name;
  }
  EXPECT_FALSE(AwaitEvent(Join(Role::kOperator).get(), "hello").is_null());
}

constexpr const char* kStudy = R"(
format: hvas-study-1
id: attack
title: A peg
product: peg
part: peg
languages: [en]
consent: You may stop.
conditions:
  - {id: C1, name: Loose, method: hybrid, fit: H7/g6, instruction: Put it in.}
blocks:
  - {id: B1, conditions: [C1], order: given}
)";

/** The same server, which runs a study. */
class StudyAttackTest : public AttackTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    server_->Stop();
    const auto protocol = study::ParseProtocol(kStudy, "attack.yaml");
    ASSERT_TRUE(protocol) << protocol.error().ToString();
    auto folder = study::StudyFolder::Create(study_.path() / "study", *protocol, 1);
    ASSERT_TRUE(folder) << folder.error().ToString();
    StudyDesk::Options options;
    options.participant = "P01";
    options.product = "peg.step";
    options.unix_ms = [] { return std::int64_t{0}; };
    auto desk = StudyDesk::Open(std::move(*folder), bench_.get(), std::move(options));
    ASSERT_TRUE(desk) << desk.error().ToString();
    desk_ = std::move(*desk);
    ServerOptions served = MakePatient();
    served.upload_folder = folder_;
    served.desk = desk_.get();
    server_ = std::make_unique<Server>(bench_.get(), std::vector<Example>(), served);
    ASSERT_TRUE(server_->Start());
    desk_->Start();
  }

  hvas::testing::TemporaryFolder study_;
  std::unique_ptr<StudyDesk> desk_;
};

TEST_F(StudyAttackTest, ParticipantLearnsNothingThatTheStudyHidesAndDoesNothingElse) {
  const auto experimenter = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(experimenter.get(), "hello").is_null());
  const std::set<std::string> allowed{"state",  "consent", "ready", "answer", "pick",
                                      "status", "forces",  "take",  "release"};
  for (const std::string& name : SendAll(CookieOf(Role::kParticipant), MakeAttacks())) {
    EXPECT_TRUE(allowed.count(name) > 0) << name;
  }
  const auto participant = Join(Role::kParticipant);
  const Json hello = AwaitEvent(participant.get(), "hello");
  EXPECT_FALSE(hello["is_owner"]);
  EXPECT_TRUE(hello["recording"].is_null());
  for (const char* route : {"/api/recordings", "/api/recording/x", "/api/path/x.glb"}) {
    EXPECT_EQ(Get(route, {{"Cookie", CookieOf(Role::kParticipant)}}).status, 404) << route;
  }
  EXPECT_EQ(Post("/api/upload?name=a.step", "x", {{"Cookie", CookieOf(Role::kParticipant)}}).status,
            403);
  // The experimenter is still there, and the forces go off for both.
  EXPECT_TRUE(Command(participant.get(), {{"id", 1}, {"command", "forces"}, {"off", true}})["ok"]);
  EXPECT_TRUE(bench_->live().forces_off());
  EXPECT_TRUE(Command(experimenter.get(), {{"id", 1}, {"command", "status"}})["ok"]);
}

TEST_F(ServerAttackTest, LongMessagesEndTheConnectionAlone) {
  for (const std::string& cookie : {CookieOf(Role::kViewer), guest_cookie_}) {
    const auto client = JoinWith(cookie);
    client->SendMessage(Message::kText, R"({"id": 1, "command": "use", "device": ")" +
                                            std::string(1 << 20, 'a') + "\"}");
    EXPECT_TRUE(client->IsClosed());
  }
  CheckAllIsWell();
}

TEST_F(ServerAttackTest, RoutesTellNobodyButTheOwnerOfOtherProducts) {
  const std::vector<std::string> names{
      kForeign, "..",    "%2e%2e",     "..%2f..%2fetc%2fpasswd", "%2fetc%2fpasswd",
      "%00",    "a%00b", "foreign%00", "foreign%2f..%2fforeign", std::string(5000, 'a'),
      "%",      "%%%",   "nothing"};
  for (const std::string& cookie : {CookieOf(Role::kViewer), guest_cookie_, std::string()}) {
    for (const std::string& name : names) {
      for (const std::string& route :
           {"/api/recording/" + name, "/api/recording/" + name + "/file",
            "/api/recording/" + name + "/frames", "/api/recording/" + name + "/scene",
            "/api/recording/" + name + "/model.glb", "/api/model/" + name + ".glb",
            "/api/path/" + name + ".glb", "/" + name, "/api/" + name}) {
        const Reply reply = Get(route, {{"Cookie", cookie}});
        EXPECT_TRUE(reply.status >= 400) << route << " " << reply.status;
        CheckText(reply.body, route);
      }
    }
    const Reply list = Get("/api/recordings", {{"Cookie", cookie}});
    EXPECT_EQ(list.status, cookie.empty() ? 401 : 200);
    CheckText(list.body, "/api/recordings");
  }
  // The same answer whether there is one or not.
  const std::string viewer = CookieOf(Role::kViewer);
  EXPECT_EQ(Get("/api/recording/nothing", {{"Cookie", viewer}}).body,
            Get("/api/recording/foreign", {{"Cookie", viewer}}).body);
  EXPECT_EQ(Get("/api/recording/foreign", {{"Cookie", CookieOf(Role::kOperator)}}).status, 200);
  CheckAllIsWell();
}

TEST_F(ServerAttackTest, NobodyButTheOwnerInvitesOthersToWork) {
  for (const std::string& cookie : {CookieOf(Role::kViewer), guest_cookie_, std::string()}) {
    for (const char* body : {R"({"role": "operator"})", R"({"role": "participant"})", "[]", "{",
                             R"({"role": {"a": 1}})"}) {
      EXPECT_GE(Post("/api/link", body, {{"Cookie", cookie}}).status, 400) << body;
    }
  }
  EXPECT_EQ(Post("/api/link", R"({"role": "viewer"})", {{"Cookie", guest_cookie_}}).status, 200);
}

TEST_F(ServerAttackTest, NamesOfUploadsLeadNowhereElse) {
  for (const char* name : {"..%2f..%2fa.step", "/etc/passwd", "a%00.step", "%2e%2e", "..", ".", "",
                           "a%0d%0aSet-Cookie:%20a.step", "con.step", "a/b/c.step"}) {
    const Reply reply =
        Post(std::string("/api/upload?name=") + name, "x", {{"Cookie", guest_cookie_}});
    EXPECT_EQ(reply.status, 200) << name;
    CheckText(reply.body, name);
    EXPECT_EQ(CountFiles(), 2u) << "a file in a folder of its own";
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.parent_path() / "a.step"));
}

}  // namespace
}  // namespace hvas::studio
