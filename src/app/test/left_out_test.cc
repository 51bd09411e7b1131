// Parts that have no way in: why, in words, in JSON and as pictures.

#include <string>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/obj_text.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using ::testing::IsNotSubstring;
using ::testing::IsSubstring;
using testing::ObjText;
using testing::Ran;
using testing::ReadSchema;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;
using testing::Validate;

/** A pin of 20 mm pressed into a bottle whose mouth is 10 mm wide, and a lid on it. A part with a
 press fit is not searched for a way that turns, which would take its time. */
class PinInBottle : public ::testing::Test {
 protected:
  void SetUp() override {
    ObjText obj(32, 6);
    obj.AddObject("bottle");
    obj.AddTurned({{15, 0}, {15, 30}, {5, 30}, {5, 27}, {10, 27}, {10, 3}}, 0);
    obj.AddObject("pin");
    obj.AddTurned({{10, 3}, {10, 15}}, 0);
    obj.AddObject("lid");
    obj.AddTurned({{12, 30}, {12, 34}}, 0);
    file_ = folder_.Write("bottle.obj", obj.text()).string();
    (void)folder_.Write("bottle.hvas.json",
                        R"({"format": "hvas-assignments-2",
                            "fits": [{"hole": "bottle", "shaft": "pin", "fit": "H7/p6"}]})");
  }

  [[nodiscard]] std::string In(const char* name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
  std::string file_;
};

/** The reason of the one part that is left out. */
void ExpectReason(const json& why) {
  EXPECT_EQ(Validate(ReadSchema("gap_reason"), why), std::vector<std::string>{});
  EXPECT_PRED_FORMAT2(IsSubstring, "pin", why["name"].get<std::string>());
  EXPECT_FALSE(why["has_way"].get<bool>());
  EXPECT_FALSE(why["best_way"]["stops"].empty());
  EXPECT_FALSE(why["changes"].empty());
}

TEST_F(PinInBottle, APlanHasItsReasonByTheSchema) {
  const json plan = RunHvasJson({"plan", file_}, 2);
  EXPECT_EQ(Validate(ReadSchema("plan"), plan), std::vector<std::string>{});
  ASSERT_EQ(plan["left_out"].size(), 1U);
  ExpectReason(plan["left_out"][0]["why"]);
  json wrong = plan;
  wrong["left_out"][0]["why"]["proof"]["kind"] = "guessed";
  EXPECT_EQ(Validate(ReadSchema("plan"), wrong).size(), 1U);
  wrong = plan;
  wrong["left_out"][0]["why"]["best_way"]["stops"][0].erase("with");
  EXPECT_EQ(Validate(ReadSchema("plan"), wrong).size(), 1U);
  wrong = plan;
  wrong["left_out"][0]["why"]["changes"][0]["colour"] = 1;
  EXPECT_EQ(Validate(ReadSchema("plan"), wrong).size(), 1U);
}

TEST_F(PinInBottle, AssembleTellsTheReasonAndWhereItIsDrawn) {
  const Ran ran = RunHvas({"assemble", file_});
  EXPECT_EQ(ran.status, 2);
  EXPECT_PRED_FORMAT2(IsSubstring, "LEFT OUT: ", ran.out);
  const json plan = RunHvasJson({"plan", file_}, 2);
  const std::string first = plan["left_out"][0]["why"]["text"][0];
  EXPECT_PRED_FORMAT2(IsSubstring, first.substr(0, 40), ran.out) << "as hvas plan has it";
  EXPECT_PRED_FORMAT2(IsSubstring, "hvas plan ", ran.out);
  const Ran brief = RunHvas({"assemble", file_, "--reasons", "0"});
  EXPECT_PRED_FORMAT2(IsNotSubstring, "LEFT OUT: ", brief.out);
  const json run = RunHvasJson({"assemble", file_}, 2);
  EXPECT_EQ(Validate(ReadSchema("assemble"), run), std::vector<std::string>{});
  int reasons = 0;
  for (const json& part : run["parts"]) {
    if (part.contains("why")) {
      ++reasons;
      EXPECT_FALSE(part["seated"].get<bool>());
      ExpectReason(part["why"]);
    }
  }
  EXPECT_EQ(reasons, 1);
}

TEST_F(PinInBottle, TheReportOfARecordHasTheReasonAndItsPicture) {
  const std::string record = In("run.hvasrec");
  const Ran ran = RunHvas({"assemble", file_, "--record", record});
  EXPECT_PRED_FORMAT2(IsSubstring, "hvas report ", ran.out);
  const std::string page = In("run.html");
  const Ran report = RunHvas({"report", record, "-o", page});
  ASSERT_EQ(report.status, 0) << report.err;
  const std::string html = ReadText(page);
  const json plan = RunHvasJson({"plan", file_}, 2);
  EXPECT_PRED_FORMAT2(IsSubstring, "<h2 id=\"left-out\">", html);
  EXPECT_PRED_FORMAT2(IsSubstring, "</span> part has no way in", html);
  for (const json& line : plan["left_out"][0]["why"]["text"]) {
    EXPECT_PRED_FORMAT2(IsSubstring, line.get<std::string>(), html);
  }
  const std::size_t section = html.find("id=\"left-out\"");
  const std::size_t picture = html.find("data:image/png;base64,", section);
  EXPECT_LT(picture, html.find("<h2>", section)) << "in its section";
  // Without the reasons it has the name only, and prepares nothing.
  ASSERT_EQ(RunHvas({"report", record, "-o", page, "--force", "--reasons", "0"}).status, 0);
  const std::string brief = ReadText(page);
  EXPECT_PRED_FORMAT2(IsSubstring, "pin</span></li>", brief);
  EXPECT_LT(brief.size(), html.size());
}

}  // namespace
}  // namespace hvas::app
