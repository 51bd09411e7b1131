#include "studio/workbench_recordings.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "record/reader.h"
#include "session/replay.h"
#include "studio/frame_codec.h"
#include "studio/test/workbench_fixture.h"

namespace hvas::studio {
namespace {

using simulation::Placement;
using testing::kPeg;

/** Checks frames as a page reads them: all bodies come first, and time never goes back. */
void CheckFrames(const std::string& bytes) {
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

class WorkbenchRecordingsTest : public testing::WorkbenchFixture {};

TEST_F(WorkbenchRecordingsTest, X14RecordingIsListedPlayedAndRunAgainBitForBit) {  // N7
  EXPECT_FALSE(bench_.recordings().Start(""));  // nothing is open
  OpenPeg();
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.recordings().Start("first try"));
  const auto begun = log_.Await("recording", start);
  ASSERT_TRUE(begun);
  EXPECT_EQ((*begun)["on"], true);
  const std::string id = (*begun)["id"];
  EXPECT_FALSE(bench_.recordings().Start("another"));
  EXPECT_FALSE(bench_.recordings().Delete(id));
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  const std::int64_t worked_ns = bench_.live().frame().frame.t_ns;
  ASSERT_TRUE(bench_.edits().Undo());  // another stretch
  ASSERT_TRUE(log_.AwaitTrue([&] {
    const std::int64_t t_ns = bench_.live().frame().frame.t_ns;
    return t_ns > 200'000'000 && t_ns < worked_ns;
  }));
  EXPECT_EQ(PlacementOf(kPeg), Placement::kLoose);
  ASSERT_TRUE(bench_.recordings().Stop());
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "recording" && e["on"] == false; }, start));
  EXPECT_FALSE(bench_.recordings().Stop());
  EXPECT_TRUE(bench_.recordings().Describe().is_null());

  const Json list = bench_.recordings().shelf().List()["recordings"];
  const auto listed =
      std::find_if(list.begin(), list.end(), [&](const Json& entry) { return entry["id"] == id; });
  ASSERT_NE(listed, list.end());
  EXPECT_EQ((*listed)["name"], "first try");
  EXPECT_EQ((*listed)["is_complete"], true);
  EXPECT_GT((*listed)["duration_s"], 4);

  const auto described = bench_.recordings().shelf().Describe(id);
  ASSERT_TRUE(described) << described.error().ToString();
  const Json detail = Json::parse(*described);
  ASSERT_EQ(detail["results"].size(), 1u);
  const Json& result = detail["results"][0];
  EXPECT_EQ(result["occurrence"], kPeg);
  EXPECT_EQ(result["is_seated"], true);
  EXPECT_GT(result["time_s"], 1);
  EXPECT_GT(result["path_m"], 0.05);
  CheckFrames(*bench_.recordings().shelf().Read(id, RecordPart::kFrames));
  const auto scene = bench_.recordings().shelf().Read(id, RecordPart::kScene);
  ASSERT_TRUE(scene);
  EXPECT_EQ(Json::parse(*scene)["occurrences"].size(), 2u);
  EXPECT_EQ(*bench_.recordings().shelf().Read(id, RecordPart::kModel), *bench_.live().scene()->glb);

  auto reader = record::Reader::Open(*bench_.recordings().shelf().Find(id));
  ASSERT_TRUE(reader);
  const auto replay = session::Replay(&*reader, bench_.live().scene()->model, {});
  ASSERT_TRUE(replay) << replay.error().ToString();
  EXPECT_TRUE(replay->is_exact());
  EXPECT_EQ(replay->stretches, 2);
  EXPECT_GT(replay->ticks, 4000);

  EXPECT_TRUE(bench_.recordings().Delete(id));
  EXPECT_FALSE(bench_.recordings().shelf().Find(id));
}

TEST_F(WorkbenchRecordingsTest, ChangeOfTheProductEndsTheRecording) {
  OpenPeg();
  ASSERT_TRUE(bench_.recordings().Start(""));
  ASSERT_TRUE(log_.Await("recording"));
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.edits().Change(
      {"change", nullptr, [](product::Product*) -> Result<void> { return {}; }}));
  const auto ended = log_.Await("recording", start);
  ASSERT_TRUE(ended);
  EXPECT_EQ((*ended)["on"], false);
  const auto described = bench_.recordings().shelf().Describe((*ended)["id"]);
  ASSERT_TRUE(described);
  EXPECT_EQ(Json::parse(*described)["is_complete"], true);
}

TEST_F(WorkbenchRecordingsTest, RecordingThatVanishesIsToldOfAndWorkGoesOn) {
  OpenPeg();
  const std::size_t start = log_.size();
  ASSERT_TRUE(bench_.recordings().Start(""));
  const auto begun = log_.Await("recording", start);
  ASSERT_TRUE(begun);
  const auto file = bench_.recordings().shelf().Find((*begun)["id"]);
  ASSERT_TRUE(file);
  std::filesystem::remove(*file);
  const auto failed = log_.Await("failed", start);
  ASSERT_TRUE(failed);
  EXPECT_EQ((*failed)["file"], "recording");
  const std::string message = (*failed)["error"]["message"];
  EXPECT_NE(message.find("removed or replaced"), std::string::npos) << message;
  ASSERT_TRUE(log_.Await(
      [](const Json& e) { return e["event"] == "recording" && e["on"] == false; }, start));
  EXPECT_TRUE(bench_.recordings().Describe().is_null());
  TakePeg();
  EXPECT_FALSE(HasFatalFailure());
}

TEST_F(WorkbenchRecordingsTest, RecordingsHaveNamesOfTheirOwnAndOthersWhenTheyAreGiven) {
  OpenPeg();
  std::vector<std::string> ids;
  for (int i = 0; i < 2; ++i) {
    const std::size_t start = log_.size();
    ASSERT_TRUE(bench_.recordings().Start(""));
    ASSERT_TRUE(
        log_.Await([](const Json& e) { return e["event"] == "recording" && e["on"]; }, start));
    ASSERT_TRUE(bench_.recordings().Stop());
    const auto ended =
        log_.Await([](const Json& e) { return e["event"] == "recording" && !e["on"]; }, start);
    ASSERT_TRUE(ended);
    ids.push_back((*ended)["id"]);
  }
  const auto name_of = [this](const std::string& id) -> std::string {
    const auto described = bench_.recordings().shelf().Describe(id);
    return described ? Json::parse(*described)["name"] : "";
  };
  EXPECT_NE(name_of(ids[0]), name_of(ids[1]));
  const auto file = bench_.recordings().shelf().Find(ids[0]);
  ASSERT_TRUE(file);
  const auto written = std::filesystem::last_write_time(*file);
  ASSERT_TRUE(bench_.recordings().Rename(ids[0], "Erster Versuch, H7/p6 \u00e4"));
  EXPECT_EQ(name_of(ids[0]), "Erster Versuch, H7/p6 \u00e4");
  EXPECT_EQ(std::filesystem::last_write_time(*file), written) << "the record stays as it was";
  bool is_listed = false;
  const Json list = bench_.recordings().shelf().List();
  for (const Json& entry : list["recordings"]) {
    is_listed = is_listed || (entry["id"] == ids[0] && entry["name"] == name_of(ids[0]));
  }
  EXPECT_TRUE(is_listed);
  for (const std::string& bad : {std::string(), std::string("  "), std::string(300, 'x')}) {
    EXPECT_FALSE(bench_.recordings().Rename(ids[0], bad)) << bad;
  }
  EXPECT_FALSE(bench_.recordings().Rename("../none", "x"));
  for (const std::string& id : ids) {
    EXPECT_TRUE(bench_.recordings().Delete(id));
  }
}

TEST_F(WorkbenchRecordingsTest, RecordingsAreFoundByTheirIdAlone) {
  for (const char* id : {"", ".", "..", "../../etc/passwd", "/etc/passwd", "a/b", "none"}) {
    EXPECT_FALSE(bench_.recordings().shelf().Find(id)) << id;
    EXPECT_FALSE(bench_.recordings().Delete(id)) << id;
    EXPECT_FALSE(bench_.recordings().shelf().Read(id, RecordPart::kFrames)) << id;
  }
}

}  // namespace
}  // namespace hvas::studio
