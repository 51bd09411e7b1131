// The folder of recordings, in which anything may lie: malformed records, pipes, links.

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <tuple>

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
  const auto share = [&](const std::string& id, bool is_shared) -> bool {
    return Command(owner.get(), {{"id", 5},
                                 {"command", "share_recording"},
                                 {"recording", id},
                                 {"shared", is_shared}})["ok"];
  };
  const auto status = [this](const std::string& what) {
    return Get("/api/recording/" + what, {{"Cookie", CookieOf(Role::kViewer)}}).status;
  };
  EXPECT_EQ(list(Role::kOperator), (std::set<std::string>{"other", "own"}));
  EXPECT_EQ(list(Role::kViewer), std::set<std::string>());
  EXPECT_EQ(status("own/file"), 404);
  EXPECT_TRUE(share("own", true));
  EXPECT_FALSE(share("other", true)) << "it is of another product";
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
  EXPECT_TRUE(share("own", false));
  EXPECT_EQ(list(Role::kViewer), std::set<std::string>());
  EXPECT_EQ(status("own/file"), 404);
  for (const char* name : {"own.hvasrec", "other.hvasrec", "shared.json"}) {
    std::filesystem::remove(folder_of_recordings_ / name);
  }
}

TEST_F(ServerRecordingsTest, ANameEndsNeitherTheHeaderNorItsValue) {
  for (const auto& [name, target, value] :
       {std::tuple("a\r\nSet-Cookie: x=1\r\n\r\n<b>.hvasrec",
                   "a%0D%0ASet-Cookie%3A%20x=1%0D%0A%0D%0A%3Cb%3E",
                   "attachment; filename=\"a__Set-Cookie: x=1____<b>.hvasrec\"; "
                   "filename*=UTF-8''a%0D%0ASet-Cookie%3A%20x%3D1%0D%0A%0D%0A%3Cb%3E.hvasrec"),
        {"x\"; filename=\"y.hvasrec", "x%22%3B%20filename=%22y",
         "attachment; filename=\"x_; filename=_y.hvasrec\"; "
         "filename*=UTF-8''x%22%3B%20filename%3D%22y.hvasrec"},
        {"\xc3\xa4.hvasrec", "%C3%A4",
         "attachment; filename=\"__.hvasrec\"; filename*=UTF-8''%C3%A4.hvasrec"},
        {"pump 2.hvasrec", "pump%202", "attachment; filename=\"pump 2.hvasrec\""}}) {
    Record(name, {}, "{}");
    const Reply reply = GetKnown(std::string("/api/recording/") + target + "/file");
    EXPECT_EQ(reply.status, 200) << name;
    EXPECT_EQ(reply.headers.count("set-cookie"), 0U);
    EXPECT_EQ(reply.headers.at("content-disposition"), value);
    EXPECT_TRUE(reply.body.starts_with("SQLite format 3"));
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
