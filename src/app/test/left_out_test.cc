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
using ::testing::IsSubstring;
using testing::ObjText;
using testing::ReadSchema;
using testing::RunHvasJson;
using testing::Validate;

/** A pin of 20 mm pressed into a bottle whose mouth is 10 mm wide, and a lid on it. A part with a
 press fit is not searched for a way that turns, which would take its time. */
class PinInBottle : public ::testing::Test {
 protected:
  void SetUp() override {
    ObjText obj(32, 6);
    obj.AddObject("bottle");
    const auto bottom = obj.AddCircle(15, 0, 0);
    const auto shoulder = obj.AddCircle(15, 30, 0);
    const auto mouth = obj.AddCircle(5, 30, 0);
    const auto neck = obj.AddCircle(5, 27, 0);
    const auto ceiling = obj.AddCircle(10, 27, 0);
    const auto floor = obj.AddCircle(10, 3, 0);
    obj.AddCap(bottom, false);
    obj.AddBand(bottom, shoulder);
    obj.AddBand(shoulder, mouth);
    obj.AddBand(mouth, neck);
    obj.AddBand(neck, ceiling);
    obj.AddBand(ceiling, floor);
    obj.AddCap(floor, true);
    AddDisc("pin", 10, 3, 15, &obj);
    AddDisc("lid", 12, 30, 34, &obj);
    file_ = folder_.Write("bottle.obj", obj.text()).string();
    (void)folder_.Write("bottle.hvas.json",
                        R"({"format": "hvas-assignments-2",
                            "fits": [{"hole": "bottle", "shaft": "pin", "fit": "H7/p6"}]})");
  }

  static void AddDisc(const std::string& name, double radius_mm, double low_mm, double high_mm,
                      ObjText* obj) {
    obj->AddObject(name);
    const auto under = obj->AddCircle(radius_mm, low_mm, 0);
    const auto over = obj->AddCircle(radius_mm, high_mm, 0);
    obj->AddCap(under, false);
    obj->AddBand(under, over);
    obj->AddCap(over, true);
  }

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

}  // namespace
}  // namespace hvas::app
