// The folder of recordings, in which anything may lie: malformed records, pipes, links.

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "record/recorder.h"
#include "studio/recording.h"
#include "studio/test/server_fixture.h"

namespace hvas::studio {
namespace {

class ServerRecordingsTest : public ServerTest {
 protected:
  ServerRecordingsTest() : folder_of_recordings_(testing::SmallBench().recordings_folder) {}

  /** Writes a finished record with one event of those that viewers are told. */
  void Record(const std::string& name, const record::Meta& meta, const std::string& told) const {
    record::RecorderOptions options;
    options.path = folder_of_recordings_ / name;
    auto recorder = record::Recorder::Create(options, meta);
    ASSERT_TRUE(recorder.has_value()) << recorder.error().ToString();
    (*recorder)->AddTick({});
    (*recorder)->AddEvent({0, kClientEventKind, record::kNoOccurrence, told});
    ASSERT_TRUE((*recorder)->Finish().has_value());
  }

  Reply GetKnown(const std::string& target, Headers more = {}) {
    more.push_back({"Cookie", CookieOf(Role::kOperator)});
    return Get(target, std::move(more));
  }

  std::filesystem::path folder_of_recordings_;
};

constexpr const char* kDropped = R"({"event": "dropped", "occurrence": 0, "metrics": {}})";

TEST_F(ServerRecordingsTest, ModelOfAnotherTypeIsNoEndOfTheStudio) {
  for (const char* model : {"[1]", "[null]", R"([{"path": 5}])", R"({"path": ""})", "7", "[[]]",
                            "\"x\"", "{", "[{\"path\": {}}, \"x\"]"}) {
    Record("model.hvasrec", {{"model_json", model}}, kDropped);
    EXPECT_EQ(GetKnown("/api/recording/model").status, 200) << model;
    std::filesystem::remove(folder_of_recordings_ / "model.hvasrec");
  }
  EXPECT_EQ(GetKnown("/api/recordings").status, 200);
}

TEST_F(ServerRecordingsTest, EventsOfAnotherTypeAreNoEndOfTheStudio) {
  for (const char* told :
       {R"({"event": 5})", R"({"event": "dropped", "metrics": 5})",
        R"({"event": "dropped", "metrics": {"time_s": "x"}})",
        R"({"event": "dropped", "metrics": {"time_s": 1e999}})",
        R"({"event": "dropped", "occurrence": "x", "metrics": {}})",
        R"({"event": "dropped", "occurrence": -1, "metrics": {}})",
        R"({"event": "dropped", "occurrence": 1e300, "metrics": {}})",
        R"({"event": "dropped", "was_seated": "yes", "metrics": []})", "[]", "5", "{"}) {
    Record("event.hvasrec", {{"model_json", R"([{"path": "a"}])"}}, told);
    EXPECT_EQ(GetKnown("/api/recording/event").status, 200) << told;
    std::filesystem::remove(folder_of_recordings_ / "event.hvasrec");
  }
}

TEST_F(ServerRecordingsTest, PipesAndLinksAreNoRecordings) {
  const auto secret = folder_of_recordings_ / "secret.txt";
  std::ofstream(secret) << "secret";
  ASSERT_EQ(::mkfifo((folder_of_recordings_ / "pipe.hvasrec").c_str(), 0600), 0);
  std::filesystem::create_symlink(secret, folder_of_recordings_ / "link.hvasrec");
  std::filesystem::create_directory(folder_of_recordings_ / "folder.hvasrec");
  for (const char* id : {"pipe", "link", "folder"}) {
    for (const char* what : {"", "/file", "/frames", "/scene", "/model.glb"}) {
      EXPECT_EQ(GetKnown(std::string("/api/recording/") + id + what).status, 404) << id << what;
    }
  }
  const Reply list = GetKnown("/api/recordings");
  EXPECT_EQ(list.status, 200);
  EXPECT_EQ(list.body.find("pipe"), std::string::npos);
  for (const char* name : {"pipe.hvasrec", "link.hvasrec", "folder.hvasrec", "secret.txt"}) {
    std::filesystem::remove(folder_of_recordings_ / name);
  }
}

TEST_F(ServerRecordingsTest, NamesWithSpacesAndLettersOfAllLanguagesAreFound) {
  Record("pump 2 \xc3\xa4.hvasrec", {}, "{}");
  EXPECT_EQ(GetKnown("/api/recording/pump%202%20%C3%A4").status, 200);
  EXPECT_EQ(GetKnown("/api/recording/pump%202%20%c3%a4/file").status, 200);
  EXPECT_EQ(GetKnown("/api/recording/pump%202%20%zz").status, 404);
  EXPECT_EQ(GetKnown("/api/recording/..%2f..%2fetc%2fpasswd/file").status, 404);
  std::filesystem::remove(folder_of_recordings_ / "pump 2 \xc3\xa4.hvasrec");
}

TEST_F(ServerRecordingsTest, ViewersGetWhatTheOwnerHasSharedWhileItsProductIsOpen) {
  const auto owner = JoinAndOpen();
  const std::string digest = bench_->recordings().FindDigest();
  ASSERT_FALSE(digest.empty());
  Record("own.hvasrec", {{"product", "a"}, {kProductDigestMeta, digest}}, "{}");
  Record("other.hvasrec", {{"product", "b"}, {kProductDigestMeta, "another"}}, "{}");
  const auto list = [this](Role role) {
    std::set<std::string> ids;
    const Json told = Json::parse(Get("/api/recordings", {{"Cookie", CookieOf(role)}}).body);
    for (const Json& entry : told["recordings"]) {
      ids.insert(entry["id"].get<std::string>());
    }
    return ids;
  };
  const auto share = [&](const std::string& id, bool is_shared) {
    EXPECT_TRUE(Command(owner.get(), {{"id", 5},
                                      {"command", "share_recording"},
                                      {"recording", id},
                                      {"shared", is_shared}})["ok"]);
    EXPECT_FALSE(AwaitEvent(owner.get(), "recordings").is_null());
  };
  const auto status = [this](const std::string& what) {
    return Get("/api/recording/" + what, {{"Cookie", CookieOf(Role::kViewer)}}).status;
  };
  EXPECT_EQ(list(Role::kOperator), (std::set<std::string>{"other", "own"}));
  EXPECT_EQ(list(Role::kViewer), std::set<std::string>());
  EXPECT_EQ(status("own/file"), 404);
  share("own", true);
  share("other", true);  // of another product: refused
  EXPECT_EQ(list(Role::kViewer), std::set<std::string>{"own"});
  EXPECT_EQ(status("own"), 200);
  EXPECT_EQ(status("own/file"), 200);
  EXPECT_EQ(status("other"), 404);
  EXPECT_EQ(status("other/file"), 404);
  // What is shared is so after the next start, and with its product alone.
  RecordingShelf after(folder_of_recordings_);
  EXPECT_TRUE(after.IsShared("own", digest));
  EXPECT_FALSE(after.IsShared("own", "another"));
  EXPECT_FALSE(after.IsShared("other", "another"));
  share("own", false);
  EXPECT_EQ(list(Role::kViewer), std::set<std::string>());
  EXPECT_EQ(status("own/file"), 404);
  for (const char* name : {"own.hvasrec", "other.hvasrec", "shared.json"}) {
    std::filesystem::remove(folder_of_recordings_ / name);
  }
}

TEST_F(ServerRecordingsTest, ConnectionIsClosedForThoseWhoAskForIt) {
  const auto client = Connect();
  const Reply reply = client->Ask({"GET", "/", {{"Host", host()}, {"Connection", "close"}}, ""});
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.headers.at("connection"), "close");
  EXPECT_TRUE(client->IsClosed());
}

}  // namespace
}  // namespace hvas::studio
