#include <cmath>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ProductFile;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

/** A bushing rig of one's own, with a side file or without. */
class MateTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy_file(ProductFile("bushing"), rig_);
    const json listed = List();
    for (const json& mate : listed["mates"]) {
      keys_.push_back(mate["key"]);
    }
    ASSERT_EQ(keys_.size(), 4U);
  }

  json List() const { return RunHvasJson({"mate", "list", rig_}); }

  [[nodiscard]] std::string SideText() const { return ReadText(side_); }

  /** Expects success. @returns what was said. */
  static std::string Run(const std::vector<std::string>& arguments) {
    const Ran ran = RunHvas(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    return ran.out;
  }

  /** Expects an error with a text, and that the side file stays. */
  void ExpectUnchanged(const std::vector<std::string>& arguments, const std::string& text) const {
    const std::string before = std::filesystem::exists(side_) ? SideText() : "";
    EXPECT_EQ(testing::ExpectRefusal(arguments, {text}).status, 1);
    EXPECT_EQ(std::filesystem::exists(side_) ? SideText() : "", before);
  }

  TemporaryFolder folder_;
  std::string rig_{(folder_ / "rig.step").string()};
  std::filesystem::path side_{folder_ / "rig.hvas.json"};
  std::vector<std::string> keys_;
};

TEST_F(MateTest, X12RemovedMatesAreGoneUntilTheyAreRestored) {
  const json before = List();
  const std::string said = Run({"mate", "remove", rig_, "m0", keys_[3]});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "hvas mate restore", said);
  const json after = List();
  ASSERT_EQ(after["mates"].size(), 2U);
  EXPECT_EQ(after["mates"][0]["key"], keys_[1]);
  EXPECT_EQ(after["mates"][0]["id"], 0);
  EXPECT_EQ(after["removed"][0]["key"], keys_[0]);
  EXPECT_EQ(RunHvasJson({"inspect", rig_})["summary"]["mates"]["axis_hole"], 1);
  ExpectUnchanged({"mate", "remove", rig_, keys_[0]}, "hvas mate restore");
  ExpectUnchanged({"mate", "restore", rig_, keys_[1]}, "is not removed");
  Run({"mate", "restore", rig_, keys_[3], keys_[0]});
  EXPECT_EQ(List(), before);
}

TEST_F(MateTest, X12AddedMatesTakeTheirFitAndGoWhenTheyAreRemoved) {
  Run({"mate", "remove", rig_, "m2"});
  const json features = RunHvasJson({"inspect", rig_, "--only", "features,tree"});
  const auto feature = [&features](std::size_t part, const char* kind, double radius_mm) {
    for (const json& item : features["features"]) {
      if (item["part"] == part && item["kind"] == kind &&
          std::abs(item["radius_mm"].get<double>() - radius_mm) < 1e-6) {
        return item;
      }
    }
    return json();
  };
  const json bore = feature(1, "hole", 20);
  const json shaft = feature(2, "shaft", 20);
  ASSERT_FALSE(bore.is_null() || shaft.is_null());
  // By a face on one side, by a feature on the other.
  const std::string a = "bushing:" + std::to_string(bore["faces"][0].get<int>());
  const std::string b = "shaft:feature" + std::to_string(shaft["id"].get<int>());
  const std::string said = Run({"mate", "add", rig_, "--a", a, "--b", b, "--fit", "H7/p6"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "added m3 " + keys_[2], said);
  json mate = List()["mates"][3];
  EXPECT_EQ(mate["origin"], "user");
  EXPECT_EQ(mate["fit"]["code"], "H7/p6");
  EXPECT_EQ(mate["fit"]["is_proposed"], false);
  // Taken away it leaves what was there before it; and the way back is told.
  const std::string removed = Run({"mate", "remove", rig_, "m3"});
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "undo: hvas mate add", removed);
  EXPECT_EQ(List()["mates"].size(), 3U);
  for (const char* side : {"bushing", "bushing:", ":3", "bushing:x", "bushing:feature", "bush:1"}) {
    ExpectUnchanged({"mate", "add", rig_, "--a", side, "--b", b}, "--a");
  }
  ExpectUnchanged({"mate", "add", rig_, "--a", "bushing:999", "--b", b}, "999");
  ExpectUnchanged({"mate", "add", rig_, "--a", b, "--b", b}, "rig.hvas.json");
  ExpectUnchanged({"mate", "add", rig_, "--a", a, "--b", b, "--fit", "H7/q99"}, "q99");
}

TEST_F(MateTest, EditsKeepWhatElseIsInTheSideFile) {
  const std::string text =
      "{\"note\": \"from the shop\", \"fits\": [{\"note\": \"first\", \"shaft\": \"shaft\", "
      "\"hole\": \"bushing\",\n\"fit\": \"H7/k6\", \"friction\": 0.11}], \"format\": "
      "\"hvas-assignments-1\"}";
  (void)folder_.Write("rig.hvas.json", text);
  Run({"mate", "remove", rig_, "m1"});
  const auto document = nlohmann::ordered_json::parse(SideText());
  EXPECT_EQ(document.begin().key(), "note");
  EXPECT_EQ(document["format"], "hvas-assignments-2");
  EXPECT_EQ(document["fits"].dump(), nlohmann::ordered_json::parse(text)["fits"].dump());
  Run({"mate", "restore", rig_, keys_[1]});
  auto expected = nlohmann::ordered_json::parse(text);
  expected["format"] = "hvas-assignments-2";
  EXPECT_EQ(nlohmann::ordered_json::parse(SideText()).dump(), expected.dump());
}

TEST_F(MateTest, WrongSideFilesAreNotTouchedButRestoreMendsThem) {
  (void)folder_.Write("rig.hvas.json",
                      "{\"format\": \"hvas-assignments-2\",\n\"removed\": [{\"mate\": \"beef\"}]}");
  ExpectUnchanged({"mate", "list", rig_}, "rig.hvas.json:2, removed 1");
  ExpectUnchanged({"mate", "remove", rig_, "m0"}, "rig.hvas.json:2, removed 1");
  Run({"mate", "restore", rig_, "beef"});
  EXPECT_EQ(List()["mates"].size(), 4U);
  (void)folder_.Write("rig.hvas.json", "{\"format\": \"hvas-assignments-2\",\n\"fits\": [}");
  ExpectUnchanged({"mate", "restore", rig_, "beef"}, "rig.hvas.json:2");
}

TEST_F(MateTest, FirstSideFileChangesNothingAndIsNotWrittenOver) {
  const json before = List();
  Run({"inspect", rig_, "--write-assignments"});
  const json document = json::parse(SideText());
  ASSERT_EQ(document["fits"].size(), 2U);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "proposed clearance",
                      document["fits"][0]["note"].get<std::string>());
  json after = List();
  ASSERT_EQ(after["mates"].size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    json was = before["mates"][i];
    json is = after["mates"][i];
    if (was.contains("fit")) {  // The same, but now stated.
      EXPECT_EQ(is["fit"]["is_proposed"], false);
      EXPECT_EQ(is["fit"]["code"], was["fit"]["code"]);
      was.erase("fit");
      is.erase("fit");
    }
    EXPECT_EQ(is, was);
  }
  ExpectUnchanged({"inspect", rig_, "--write-assignments"}, "--force");
  Run({"mate", "remove", rig_, "m1"});
  Run({"inspect", rig_, "--write-assignments", "--force"});
  EXPECT_EQ(List()["removed"].size(), 1U);
  Run({"inspect", rig_, "--write-assignments", (folder_ / "other.json").string()});
  ExpectUnchanged({"inspect", rig_, "--write-assignments", (folder_ / "no" / "x.json").string()},
                  "folder");
}

}  // namespace
}  // namespace hvas::app
