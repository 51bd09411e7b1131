// Forces off reaches the run whatever else the server is asked for, and what takes long is done by
// others than the network thread.

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/await_true.h"
#include "record/recorder.h"
#include "studio/answer_lanes.h"
#include "studio/record_parts.h"
#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

using testing::Headers;
using testing::Message;
using testing::RawClient;
using testing::Reply;
using testing::ServerTest;

/** A server whose recordings are read by a program that the test writes. */
class FloodTest : public ServerTest {
 protected:
  FloodTest() : recordings_(testing::SmallBench().recordings_folder) {}

  ~FloodTest() override {
    for (const char* name : {"a.hvasrec", "big.hvasrec"}) {
      std::filesystem::remove(recordings_ / name);
    }
  }

  void TearDown() override {
    End();  // No thread reads the environment any more.
    ::unsetenv("HVAS_RECORD_WORKER");
  }

  /** @param script  For a shell; to be called before anything is requested. */
  void ReadRecordsBy(const std::string& script) {
    const auto program = scripts_ / "reader";
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("HVAS_RECORD_WORKER", program.c_str(), 1);
  }

  void Record(const record::Meta& meta, const std::vector<std::string>& events) const {
    record::RecorderOptions options;
    options.path = recordings_ / "a.hvasrec";
    auto recorder = record::Recorder::Create(options, meta);
    ASSERT_TRUE(recorder.has_value()) << recorder.error().ToString();
    (*recorder)->AddTick({});
    for (const std::string& event : events) {
      (*recorder)->AddEvent({0, kClientEventKind, record::kNoOccurrence, event});
    }
    ASSERT_TRUE((*recorder)->Finish().has_value());
  }

  Reply GetAs(Role role, const std::string& target) {
    return Get(target, {{"Cookie", CookieOf(role)}});
  }

  /** Requests something, and does not wait for the response. */
  std::unique_ptr<RawClient> SendGet(Role role, const std::string& target) {
    auto client = Connect();
    client->Send({"GET", target, {{"Host", host()}, {"Cookie", CookieOf(role)}}, ""});
    return client;
  }

  void ExpectForcesOffWork(RawClient* client) {
    EXPECT_FALSE(bench_->live().forces_off());
    EXPECT_TRUE(Command(client, {{"id", 70}, {"command", "forces"}, {"off", true}})["ok"]);
    EXPECT_TRUE(bench_->live().forces_off());
  }

  hvas::testing::TemporaryFolder scripts_;
  std::filesystem::path recordings_;
};

TEST_F(FloodTest, ForcesOffAndThePagePassRecordsThatAreNeverRead) {
  Record({}, {});
  const auto begun = scripts_ / "begun";
  ReadRecordsBy("touch '" + begun.string() + "'; exec sleep 1000");
  const auto steering = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(steering.get(), "hello").is_null());
  std::vector<std::unique_ptr<RawClient>> waiting;
  for (const char* target : {"/api/recordings", "/api/recording/a", "/api/recording/a/frames",
                             "/api/recording/a/scene"}) {
    waiting.push_back(SendGet(Role::kOperator, target));
    waiting.push_back(SendGet(Role::kViewer, "/api/recordings"));
  }
  ASSERT_TRUE(hvas::testing::AwaitTrue([&] { return std::filesystem::exists(begun); }));
  EXPECT_EQ(GetAs(Role::kViewer, "/api/scene").status, 404) << "nothing is open";
  EXPECT_EQ(GetAs(Role::kOperator, "/api/scene").status, 404);
  ExpectForcesOffWork(steering.get());
}

TEST_F(FloodTest, ForcesOffPassesUploadsAndConnectionsOfViewers) {
  const auto steering = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(steering.get(), "hello").is_null());
  std::vector<std::unique_ptr<RawClient>> flood;
  for (int i = 0; i < 10; ++i) {
    flood.push_back(Connect());
    flood.back()->Send("POST /api/upload?name=a.stp HTTP/1.1\r\nHost: " + host() +
                       "\r\nOrigin: " + origin() + "\r\nCookie: " + CookieOf(Role::kOperator) +
                       "\r\nContent-Length: 9000\r\n\r\n" + std::string(4000, 'x'));
  }
  for (int i = 0; i < 30; ++i) {
    flood.push_back(SendGet(Role::kViewer, "/api/scene"));
  }
  ExpectForcesOffWork(steering.get());
}

TEST_F(FloodTest, RecordThatEndsItsReaderIsAnErrorAndNoEndOfTheStudio) {
  Record({}, {});
  ReadRecordsBy("kill -SEGV $$");
  const Reply reply = GetAs(Role::kOperator, "/api/recording/a");
  EXPECT_EQ(reply.status, 500);
  EXPECT_NE(reply.body.find("crashed"), std::string::npos) << reply.body;
  EXPECT_EQ(GetAs(Role::kOperator, "/api/recordings").status, 200);
}

TEST_F(FloodTest, ReaderThatWritesAnythingIsAnError) {
  Record({}, {});
  for (const char* script : {"exit 0", "printf - >&4", "printf '+[]' >&4",
                             "printf '-{\"code\":99}' >&4", "printf '+{\"name\":5}' >&4"}) {
    ReadRecordsBy(script);
    EXPECT_EQ(GetAs(Role::kOperator, "/api/recordings").status, 200) << script;
  }
}

TEST_F(FloodTest, ModelIsParsedOnceForAllPartsThatWereDropped) {
  constexpr int kDropped = 1000;  // With a model for each, the reader would run out of its 20 s.
  std::string model = "[";
  for (int i = 0; i < 40'000; ++i) {
    model +=
        R"({"path": "rig/housing/screw)" + std::to_string(i) + R"(", "x_m": [0.1, 0.2, 0.3]},)";
  }
  model.back() = ']';
  std::vector<std::string> events;
  for (int i = 0; i < kDropped; ++i) {
    events.push_back(R"({"event": "dropped", "occurrence": )" + std::to_string(i % 500) +
                     R"(, "metrics": {"time_s": 1}})");
  }
  Record({{"model_json", model}}, events);
  const Reply reply = GetAs(Role::kOperator, "/api/recording/a");
  ASSERT_EQ(reply.status, 200) << reply.body;
  const Json results = Json::parse(reply.body)["results"];
  ASSERT_EQ(results.size(), 500u);
  EXPECT_EQ(results[7]["path"], "rig/housing/screw7");
  EXPECT_EQ(results[7]["time_s"], 2);
}

TEST_F(FloodTest, RecordingIsDownloadedWholeInPieces) {
  std::string bytes(1'000'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(i * i % 251);
  }
  std::ofstream(recordings_ / "big.hvasrec", std::ios::binary) << bytes;
  const auto client = Connect();
  for (int i = 0; i < 2; ++i) {  // the connection goes on
    const Reply reply = client->Ask({"GET",
                                     "/api/recording/big/file",
                                     {{"Host", host()}, {"Cookie", CookieOf(Role::kOperator)}},
                                     ""});
    EXPECT_EQ(reply.status, 200);
    EXPECT_TRUE(reply.body == bytes) << reply.body.size();
  }
}

TEST_F(FloodTest, ForcesOffPassesMessagesThatWaitAndTheRateLimit) {
  const auto steering = Join(Role::kOperator);
  EXPECT_FALSE(AwaitEvent(steering.get(), "hello").is_null());
  const auto looking = Join(Role::kViewer);
  EXPECT_FALSE(AwaitEvent(looking.get(), "hello").is_null());
  const std::string large = "{\"id\": 7, \"x\": \"" + std::string(60 << 10, 'a') + "\"}";
  for (int i = 0; i < 150; ++i) {  // more than a client may send at once
    looking->SendMessage(Message::kText, large);
  }
  looking->SendMessage(Message::kText, R"({"id": 71, "command": "forces", "off": true})");
  EXPECT_TRUE(hvas::testing::AwaitTrue([this] { return bench_->live().forces_off(); }));
  const Json told = AwaitEvent(steering.get(), "forces");
  EXPECT_EQ(told["off"], true);
}

TEST_F(FloodTest, ForcesThatAreSwitchedOnAndOffAtOnceStayOff) {
  const auto client = Join(Role::kOperator);
  EXPECT_TRUE(AwaitEvent(client.get(), "hello")["has_lease"]);
  for (int round = 0; round < 20; ++round) {
    const int id = 10 * round + 100;
    Command(client.get(), {{"id", id}, {"command", "forces"}, {"off", false}});
    EXPECT_FALSE(bench_->live().forces_off());
    // Off, on and off again: what was sent before the last off never follows it.
    for (int k = 1; k <= 3; ++k) {
      client->SendMessage(Message::kText,
                          Json{{"id", id + k}, {"command", "forces"}, {"off", k != 2}}.dump());
    }
    int replies = 0;
    EXPECT_FALSE(Await(client.get(), [&](const Json& json) {
                   const int got = json.value("id", 0);
                   replies += got > id && got <= id + 3 ? 1 : 0;
                   return replies == 3;
                 }).is_null());
    EXPECT_TRUE(bench_->live().forces_off()) << round;
  }
}

TEST(AnswerLanesTest, RefuseWhatIsTooMuchAndOneDoesNotHoldUpAnother) {
  using Lane = AnswerLanes::Lane;
  std::atomic<bool> may_end{false};
  std::atomic<bool> is_done{false};
  AnswerLanes lanes;
  const auto wait = [&may_end](const std::stop_token& stop) {
    while (!may_end && !stop.stop_requested()) {
      std::this_thread::yield();
    }
  };
  int taken = 0;
  while (lanes.TryPost(Lane::kGuestsRecords, wait)) {
    ASSERT_LT(++taken, 100);
  }
  EXPECT_GT(taken, 16);
  EXPECT_TRUE(
      lanes.TryPost(Lane::kOwnersRecords, [&is_done](const std::stop_token&) { is_done = true; }));
  EXPECT_TRUE(hvas::testing::AwaitTrue([&] { return is_done.load(); }));
  lanes.Stop();  // ends the first, and forgets the others
  EXPECT_FALSE(may_end);
}

}  // namespace
}  // namespace hvas::studio
