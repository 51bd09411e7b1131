// `hvas study analyse` and `hvas study power`, by the program.

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ReadSchema;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;
using testing::Validate;

constexpr const char* kPaper = HVAS_SOURCE_DIR "/data/studies/identification-2016.csv";

class StudyStatistics : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    const std::string file = (folder_ / name).string();
    std::ofstream(file) << text;
    return file;
  }

  std::string PathOf(const std::string& name) { return (folder_ / name).string(); }

  /** What is said of a table that cannot be read. */
  std::string ErrorOf(const std::string& text, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"study", "analyse", "--table", Write("bad.csv", text)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto ran = RunHvas(arguments);
    EXPECT_EQ(ran.status, 1) << text;
    return ran.err;
  }

 private:
  hvas::testing::TemporaryFolder folder_;
};

TEST_F(StudyStatistics, PaperWsTableGivesThePublishedFigures) {
  const json document = RunHvasJson({"study", "analyse", "--table", kPaper, "--of", "15"});
  EXPECT_EQ(Validate(ReadSchema("study_analysis"), document), std::vector<std::string>{});
  EXPECT_NEAR(document["friedman"]["chi_square"].get<double>(), 8.7143, 5e-5);
  EXPECT_NEAR(document["friedman"]["p"].get<double>(), 0.0128149, 5e-8);
  EXPECT_NEAR(document["friedman"]["exact_p"].get<double>(), 0.0109036, 5e-8);
  const double p[] = {0.0091679, 0.0072138, 0.5030733};
  const double exact[] = {0.00732, 0.00598, 0.55371};
  for (std::size_t i = 0; i < 3; ++i) {
    const json& wilcoxon = document["pairs"][i]["wilcoxon"];
    EXPECT_NEAR(wilcoxon["p"].get<double>(), p[i], 5e-8);
    EXPECT_NEAR(wilcoxon["exact_p"].get<double>(), exact[i], 5e-6);
  }
}

TEST_F(StudyStatistics, LongAndWideTablesOfTheSameNumbersSayTheSame) {
  const std::string wide = Write("wide.csv", "id,A,B\n1,2,5\n2,3,3.5\n3,4,\nsum,9,8.5\n");
  const std::string long_table =
      Write("long.csv",
            "participant;condition;trial;time_s\n1;A;1;1\n1;A;2;3\n1;B;1;5\n2;A;1;3\n"
            "2;B;1;3.5\n3;A;1;4\n3;B;1;\n");
  const json a = RunHvasJson({"study", "analyse", "--table", wide});
  const json b = RunHvasJson({"study", "analyse", "--table", long_table, "--delimiter", ";",
                              "--value", "time_s", "--unit", "s"});
  EXPECT_EQ(a["conditions"], b["conditions"]);
  EXPECT_EQ(a["pairs"], b["pairs"]);
  EXPECT_EQ(b["quantity"], "time_s");
  EXPECT_EQ(a["participants"], 3);
  EXPECT_EQ(a["complete_participants"], 2);
  for (const json& document : {a, b}) {
    EXPECT_EQ(Validate(ReadSchema("study_analysis"), document), std::vector<std::string>{});
  }
}

TEST_F(StudyStatistics, AnswersMakeAConfusionMatrix) {
  const std::string file = Write("answers.csv",
                                 "participant,shown,answered\n1,H7/g6,H7/g6\n1,H7/p6,H7/g6\n"
                                 "2,H7/g6,H7/g6\n2,H7/p6,H7/p6\n");
  const json document = RunHvasJson({"study", "analyse", "--table", file});
  EXPECT_EQ(Validate(ReadSchema("study_identification"), document), std::vector<std::string>{});
  EXPECT_EQ(document["counts"], json::parse("[[2,0],[1,1]]"));
  EXPECT_EQ(document["kappa"], 0.5);
}

TEST_F(StudyStatistics, ErrorsNameFileLineAndColumn) {
  EXPECT_NE(ErrorOf("p,A,B\n1,2,3\n2,x,3\n").find("bad.csv:3, column 2 (A): \"x\""),
            std::string::npos);
  EXPECT_NE(ErrorOf("p,A,B\n\"a\nb\",2,3\n\n2,1,\"1,5\"\n").find("bad.csv:5, column 3 (B)"),
            std::string::npos);
  EXPECT_NE(ErrorOf("p,A,A\n1,2,3\n").find("bad.csv:1, column 3"), std::string::npos);
  EXPECT_NE(ErrorOf("p;A;B\n1;2;3\n").find("--delimiter ';'"), std::string::npos);
  EXPECT_NE(ErrorOf("p,A,B\n1,2,3\n2,1,3\nsum,4,6\n").find("bad.csv:4, column 2 (A)"),
            std::string::npos);
  EXPECT_NE(ErrorOf("p,A,B\n1,2,3,4\n").find("bad.csv:2"), std::string::npos);
  EXPECT_NE(ErrorOf("p,A,B\n1,2,3\n2,9,3\n", {"--of", "5"}).find("participant 2, condition A"),
            std::string::npos);
  EXPECT_NE(ErrorOf("participant,condition,value\n1,,3\n").find("bad.csv:2, column 2 (condition)"),
            std::string::npos);
}

TEST_F(StudyStatistics, PageNeedsNothingElseAndIsNotReplacedByAccident) {
  const std::string page = PathOf("page.html");
  const std::vector<std::string> arguments{"study", "analyse", "--table", kPaper,
                                           "--of",  "15",      "-o",      page};
  ASSERT_EQ(RunHvas(arguments).status, 0);
  const std::string html = ReadText(page);
  for (const char* what : {"<!doctype html>", "<svg", "Wilcoxon", "@media print"}) {
    EXPECT_NE(html.find(what), std::string::npos) << what;
  }
  for (const char* what : {"<script", "<link", "src=\"http", ">nan"}) {
    EXPECT_EQ(html.find(what), std::string::npos) << what;
  }
  EXPECT_EQ(RunHvas(arguments).status, 1);
}

TEST_F(StudyStatistics, PowerIsTheSameEveryTimeAndTellsItsError) {
  const std::vector<std::string> arguments{"study", "power",  "--means",  "0,0.6",  "--sd",
                                           "1",     "--test", "wilcoxon", "--runs", "1000"};
  const json document = RunHvasJson(arguments);
  EXPECT_EQ(Validate(ReadSchema("study_power"), document), std::vector<std::string>{});
  EXPECT_NEAR(document["participants"].get<int>(), 25, 3);
  EXPECT_EQ(document, RunHvasJson(arguments));
  const json pilot = RunHvasJson({"study", "power", "--table", kPaper, "--columns", "B1,B2",
                                  "--test", "wilcoxon", "--runs", "500", "--participants", "15"});
  EXPECT_EQ(pilot["points"].size(), 1u);
  EXPECT_EQ(RunHvas({"study", "power"}).status, 1);
  EXPECT_EQ(RunHvas({"study", "power", "--means", "1,2"}).status, 64);
}

}  // namespace
}  // namespace hvas::app
