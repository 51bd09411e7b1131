// X16: hvas tool, and tools and fixtures of a run.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/json_schema.h"
#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ProductFile;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

std::string ToolFile(const std::string& name) {
  return HVAS_SOURCE_DIR "/products/tools/" + name + ".step";
}

json RunTool(std::vector<std::string> more, int status = 0) {
  std::vector<std::string> all{"tool"};
  all.insert(all.end(), more.begin(), more.end());
  all.emplace_back("-q");
  json run = RunHvasJson(all, status);
  EXPECT_EQ(testing::Validate(testing::ReadSchema("tool"), run), std::vector<std::string>{});
  return run;
}

/** Drives of all fasteners, as "hexagon 5" with their number; a recess has a minus behind it. */
std::map<std::string, int> CountDrives(const json& run) {
  std::map<std::string, int> counts;
  for (const json& fastener : run["fasteners"]) {
    if (fastener["drives"].empty()) {
      ++counts["none"];
    }
    for (const json& drive : fastener["drives"]) {
      ++counts[drive["form"].get<std::string>() + " " +
               std::to_string(std::lround(drive["width_mm"].get<double>())) +
               (drive["is_recess"].get<bool>() ? " recess" : "")];
    }
  }
  return counts;
}

TEST(ToolCommandX16, FindsTheDrivesOfAllFastenersOfThePump) {
  EXPECT_EQ(
      CountDrives(RunTool({ProductFile("gear_pump")})),
      (std::map<std::string, int>{
          {"hexagon 5 recess", 8}, {"hexagon 4 recess", 1}, {"hexagon 24", 2}, {"hexagon 14", 1}}));
}

/** The end of the key whose lever swings: that with the longer lever. */
json FindSwing(const json& run) {
  const json& ends = run["reach"]["ends"];
  return *std::max_element(ends.begin(), ends.end(), [](const json& a, const json& b) {
    return a["lever_mm"].get<double>() < b["lever_mm"].get<double>();
  });
}

TEST(ToolCommandX16, TellsTheAngleThatIsLeftAndTheWallsThatEndIt) {
  const json run = RunTool({ProductFile("gear_pump"), "--screw", "cover screw 1"});
  EXPECT_EQ(run["reach"]["tool"], "hex_key_5");
  EXPECT_EQ(run["reach"]["ends"].size(), 2);
  const json free = FindSwing(run);
  ASSERT_EQ(free["arcs"].size(), 1);
  EXPECT_NEAR(free["arcs"][0]["angle_deg"].get<double>(), 276.3, 1);
  EXPECT_EQ(free["arcs"][0]["at_from"], "gear pump/drive shaft assembly/coupling hub");
  // A vise beside it leaves less, and is named.
  const json walled = FindSwing(RunTool({ProductFile("gear_pump"), "--screw", "cover screw 1",
                                         "--fixture", ToolFile("vise") + "@60,0,20,90"}));
  ASSERT_EQ(walled["arcs"].size(), 1);
  EXPECT_NEAR(walled["arcs"][0]["angle_deg"].get<double>(), 160.6, 1);
  EXPECT_EQ(walled["arcs"][0]["at_from"], "workshop fixtures/vise");
}

TEST(ToolCommandX16, AHexagonKeyTurnsACapScrewOfThePumpByContactWithItsSocket) {
  const hvas::testing::TemporaryFolder folder;
  const std::string table = folder / "turn.csv";
  const json turn = RunTool({ProductFile("gear_pump"), "--screw", "cover screw 1", "--turn", "90",
                             "-o", table})["reach"]["turn"];
  EXPECT_EQ(turn["is_complete"], true);
  EXPECT_NEAR(turn["angle_deg"].get<double>(), 90, 0.5);
  EXPECT_NEAR(turn["travel_mm"].get<double>(), 0.25, 0.002);  // A quarter of the pitch of M6.
  EXPECT_NEAR(turn["peak_torque_nm"].get<double>(), 0.5, 0.05);
  EXPECT_EQ(ReadText(table).substr(0, 12), "time_s,lift_");
}

TEST(ToolCommandX16, RefusesAToolThatDoesNotFit) {
  testing::ExpectRefusal({"tool", ProductFile("gear_pump"), "--screw", "end screw", "--tool",
                          ToolFile("hex_key_5"), "-q"},
                         {"does not fit it", "hexagon socket 4 mm"});
}

}  // namespace
}  // namespace hvas::app
