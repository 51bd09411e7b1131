// hvas plan: orders of assembly, what comes before what, and plans that are followed.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ExpectRefusal;
using testing::ProductFile;
using testing::RunHvasJson;

std::vector<std::size_t> PartsOf(const json& order) {
  return order["parts"].get<std::vector<std::size_t>>();
}

std::size_t FindId(const json& plan, const std::string& name) {
  for (const json& move : plan["moves"]) {
    const std::string path = move["name"];
    if (path.ends_with(name)) {
      return move["id"];
    }
  }
  ADD_FAILURE() << name;
  return 0;
}

std::ptrdiff_t PlaceOf(const json& order, std::size_t id) {
  const std::vector<std::size_t> parts = PartsOf(order);
  return std::find(parts.begin(), parts.end(), id) - parts.begin();
}

TEST(PlanTest, EachOrderObeysEveryArrowThatIsCertain) {
  const json plan = RunHvasJson({"plan", ProductFile("gear_pump")});
  EXPECT_TRUE(plan["left_out"].empty());
  EXPECT_EQ(plan["moves"].size(), 37U);
  ASSERT_FALSE(plan["orders"].empty());
  EXPECT_LE(plan["orders"][0]["cost"], plan["planned"]["cost"]);
  EXPECT_GT(plan["arrows"].size(), 20U);
  for (const json& order : plan["orders"]) {
    EXPECT_EQ(PartsOf(order).size(), 37U);
    for (const json& arrow : plan["arrows"]) {
      if (arrow["certain"].get<bool>()) {
        EXPECT_LT(PlaceOf(order, arrow["first"]), PlaceOf(order, arrow["then"])) << arrow.dump();
      }
    }
  }
}

TEST(PlanTest, TheHandIsCountedByItsWeights) {
  const std::string pump = ProductFile("gear_pump");
  const json plan = RunHvasJson({"plan", pump});
  double reach_mm = 0;
  double force_n = 0;
  double time_s = 0;
  for (const json& move : plan["moves"]) {
    reach_mm += move["reach_mm"].get<double>();
    force_n += move["force_n"].get<double>();
    time_s += move["hand_time_s"].get<double>();
  }
  const json& best = plan["orders"][0];
  EXPECT_NEAR(best["reach_m"], 1e-3 * reach_mm, 1e-9);
  EXPECT_NEAR(best["force_n"], force_n, 1e-6);
  EXPECT_NEAR(best["hand_time_s"], time_s, 1e-9);
  EXPECT_GT(reach_mm, 0);
  EXPECT_GT(time_s, 37) << "a second a part at least";
  const json timed =
      RunHvasJson({"plan", pump, "--turn-cost", "0", "--direction-cost", "0", "--tool-cost", "0",
                   "--loose-cost", "0", "--cramped-cost", "0", "--reach-cost", "0", "--force-cost",
                   "0", "--hand-time-cost", "1"});
  EXPECT_EQ(timed["weights"]["hand_time_per_s"], 1);
  EXPECT_NEAR(timed["orders"][0]["cost"], timed["orders"][0]["hand_time_s"], 1e-9);
  EXPECT_LE(timed["orders"][0]["hand_time_s"], timed["planned"]["hand_time_s"]);
}

TEST(PlanTest, APlanIsFollowed) {
  const TemporaryFolder folder;
  const std::string file = (folder / "plan.json").string();
  const std::string pump = ProductFile("gear_pump");
  const json plan = RunHvasJson({"plan", pump, "-o", file});
  const json run = RunHvasJson({"assemble", pump, "--plan", file});
  EXPECT_EQ(run["seated"], run["parts"].size());
  std::vector<std::size_t> order;
  for (const json& part : run["parts"]) {
    order.push_back(part["id"]);
  }
  const std::vector<std::size_t> planned = PartsOf(plan["orders"][0]);
  // The base comes first.
  EXPECT_TRUE(std::equal(planned.begin(), planned.end(),
                         order.end() - static_cast<std::ptrdiff_t>(planned.size())));
}

TEST(PlanTest, WishesAreObeyedAndContradictionsSaid) {
  const std::string pump = ProductFile("gear_pump");
  const json plan = RunHvasJson({"plan", pump, "--before", "bleed plug", "hose nipple 2",
                                 "--before", "hose nipple 2", "hose nipple 1"});
  for (const json& order : plan["orders"]) {
    const auto place = [&](const char* name) { return PlaceOf(order, FindId(plan, name)); };
    EXPECT_LT(place("bleed plug"), place("hose nipple 2"));
    EXPECT_LT(place("hose nipple 2"), place("hose nipple 1"));
  }
  ExpectRefusal({"plan", pump, "--before", "oil seal", "cover"},
                {"gear_pump.step", "oil seal is to come before", "in the way"});
  ExpectRefusal({"plan", pump, "--before", "oil sael", "cover"}, {"oil sael"});
  ExpectRefusal({"plan", pump, "--base", "no such part"}, {"no such part"});
  ExpectRefusal({"plan", pump, "--order", "no such part"}, {"no such part"});
  ExpectRefusal({"plan", pump, "--order", "gasket,no such part"}, {"no such part"});
}

TEST(PlanTest, DamagedPlansAreRefused) {
  const TemporaryFolder folder;
  const std::string file = (folder / "plan.json").string();
  const std::string bushing = ProductFile("bushing");
  const json plan = RunHvasJson({"plan", bushing, "-o", file});
  ExpectRefusal({"plan", bushing, "-o", file}, {"plan.json", "--force"});
  const auto expect_refused = [&](const std::string& text, const std::string& word) {
    const std::string damaged = folder.Write("damaged.json", text).string();
    ExpectRefusal({"assemble", bushing, "--plan", damaged}, {"damaged.json", word});
  };
  expect_refused("{", "no plan");
  expect_refused("[]", "no plan");
  expect_refused(R"({"followed": {"parts": [], "steps": []}})", "other parts");
  json changed = plan;
  changed["followed"]["steps"] = json::array();
  expect_refused(changed.dump(), "base");
  changed = plan;
  changed["followed"]["steps"].push_back(plan["followed"]["steps"].back());
  expect_refused(changed.dump(), "step");
  changed = plan;
  changed["followed"]["steps"].back()["occurrence"] = 4'000'000;
  expect_refused(changed.dump(), "occurrence");
  changed = plan;
  changed["followed"]["steps"].back()["kind"] = "remove";
  expect_refused(changed.dump(), "step");
  ExpectRefusal({"assemble", ProductFile("gear_pump"), "--plan", file}, {"other parts"});
  ExpectRefusal({"assemble", bushing, "--plan", (folder / "none.json").string()}, {"none.json"});
}

TEST(PlanTest, APageIsWritten) {
  const TemporaryFolder folder;
  const std::string file = (folder / "plan.html").string();
  (void)RunHvasJson({"plan", ProductFile("bushing"), "-o", file});
  EXPECT_GT(std::filesystem::file_size(file), 1000U);
  ExpectRefusal({"plan", ProductFile("bushing"), "-o", (folder / "plan.txt").string()},
                {"plan.txt"});
}

}  // namespace
}  // namespace hvas::app
