// The shipped studies through the program: N9, X14, X15, W8 to W12. With few participants here;
// with all of them in docs/studies.md.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app::testing {
namespace {

class StudyRunTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string Folder(const std::string& name) const {
    return (scratch_ / name).string();
  }

  hvas::testing::TemporaryFolder scratch_;
};

using StudyRunReleaseTest = StudyRunTest;

TEST_F(StudyRunReleaseTest, XiaFindsWhatThePaperFound) {
  const auto json = RunHvasJson({"study", "run", "xia-2011", "--simulated", "2", "--records",
                                 "none", "-o", Folder("xia"), "--json"});
  EXPECT_EQ(Validate(ReadSchema("study_summary"), json), std::vector<std::string>{});
  EXPECT_EQ(Validate(ReadSchema("study_summary"),
                     RunHvasJson({"study", "list", Folder("xia"), "--json"})),
            std::vector<std::string>{});
  EXPECT_NE(json["what"].get<std::string>().find("simulated"), std::string::npos);
  ASSERT_EQ(json["conditions"].size(), 3U);
  for (const auto& condition : json["conditions"]) {
    EXPECT_EQ(condition["trials"], 20);
    EXPECT_GE(condition["done"], 18) << condition.dump();
    // All that are not done count with their limit of 180 s.
    const double done = condition["done"];
    const double of_done = condition["done"].get<double>() * condition["mean_time_s"].get<double>();
    EXPECT_NEAR(condition["restricted_mean_time_s"], (of_done + (20 - done) * 180) / 20, 1e-9);
  }
  // What paper X found: contact alone takes the longest.
  EXPECT_GT(json["conditions"][0]["mean_time_s"], json["conditions"][1]["mean_time_s"]);
  EXPECT_GT(json["conditions"][0]["mean_time_s"], json["conditions"][2]["mean_time_s"]);
}

TEST_F(StudyRunTest, StudyGivesTheSameAgainAndDeletesAParticipant) {
  const std::string study = WriteShortStudy("xia-2011", scratch_.path());
  const auto json = RunHvasJson({"study", "run", study, "--simulated", "2", "--records", "none",
                                 "-o", Folder("one"), "--json"});
  ASSERT_EQ(json["conditions"].size(), 3U);
  for (const auto& condition : json["conditions"]) {
    EXPECT_EQ(condition["trials"], 2);
  }
  const auto again = RunHvasJson({"study", "run", study, "--simulated", "2", "--records", "none",
                                  "--threads", "1", "-o", Folder("two"), "--json"});
  EXPECT_EQ(again["conditions"], json["conditions"]);
  for (const char* file : {"participants/P01.jsonl", "participants/P02.jsonl", "trials.csv",
                           "answers.csv", "report.html", "study.json"}) {
    const std::string one = ReadText(scratch_ / "one" / file);
    EXPECT_FALSE(one.empty()) << file;
    EXPECT_EQ(one, ReadText(scratch_ / "two" / file)) << file;
  }
  const Ran deleted = RunHvas({"study", "delete", Folder("one"), "--participant", "P02"});
  EXPECT_EQ(deleted.status, 0) << deleted.err;
  EXPECT_NE(deleted.out.find("P02.jsonl"), std::string::npos);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch_ / "one")) {
    if (entry.is_regular_file()) {
      EXPECT_EQ(ReadText(entry.path()).find("P02"), std::string::npos) << entry.path();
    }
  }
}

TEST_F(StudyRunTest, FitsRunFromConsentToTheReport) {
  const auto json =
      RunHvasJson({"study", "run", "fit-2016", "--simulated", "2", "-o", Folder("fits"), "--json"});
  EXPECT_EQ(Validate(ReadSchema("study_summary"), json), std::vector<std::string>{});
  ASSERT_EQ(json["conditions"].size(), 6U);
  for (const auto& participant : json["participants"]) {
    EXPECT_EQ(participant["phase"], "done");
    EXPECT_EQ(participant["trials_done"], 75);
  }
  // What paper W found: by contact alone, through its soft coupling, it takes the longest by hand.
  const auto& contact_alone = json["conditions"][1];
  EXPECT_GE(contact_alone["done"], 8) << contact_alone.dump();
  for (std::size_t i = 2; i < 6; ++i) {
    EXPECT_GT(contact_alone["mean_time_s"], json["conditions"][i]["mean_time_s"]);
  }
  const std::string report = ReadText(scratch_ / "fits" / "report.html");
  for (const char* part : {"Simulated.", "15.06", "49.78", "24.58", "26.73", "not printed", "H7/p6",
                           "F_z", "answer no questions"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part;
  }
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "fits" / "records" / "P01"));
}

TEST_F(StudyRunTest, WrongProtocolIsToldWithItsLine) {
  const auto file = scratch_.Write("wrong.yaml", "format: hvas-study-1\nid: a b\n");
  const Ran ran = RunHvas({"study", "check", file.string()});
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.err.find("wrong.yaml:2:5"), std::string::npos) << ran.err;
  const Ran missing = RunHvas({"study", "run", "no-such-study"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_NE(missing.err.find("fit-2016, xia-2011"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace hvas::app::testing
