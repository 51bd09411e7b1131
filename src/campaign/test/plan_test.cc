// Plans of campaigns: what is read, and what is refused, where and with which remedy.

#include "campaign/plan.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "base/units.h"

namespace hvas::campaign {
namespace {

const std::string kPlanHead =
    "format: hvas-campaign-1\n"
    "id: tiny\n"
    "products: [bushing.step]\n"
    "seeds: {count: 10}\n";

struct RefusedText {
  std::string name;
  std::string text;
  std::string where;    // Line and column.
  std::string message;  // A part of it.
};

class RefusedPlan : public ::testing::TestWithParam<RefusedText> {};

TEST_P(RefusedPlan, NamesFileFieldAndRemedy) {
  const auto plan = ParsePlan(GetParam().text, "plan.yaml");
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().where, "plan.yaml" + GetParam().where);
  EXPECT_NE(plan.error().message.find(GetParam().message), std::string::npos)
      << plan.error().ToString();
  EXPECT_FALSE(plan.error().remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedPlan,
    ::testing::Values(
        RefusedText{"Format", "format: 2\nid: a\nproducts: [a.step]\nseeds: {count: 1}\n", ":1:9",
                    "format"},
        RefusedText{"Seeds", "format: hvas-campaign-1\nid: a\nproducts: [a.step]\n", ":1:1",
                    "\"seeds\""},
        RefusedText{"UnknownKey", kPlanHead + "shard_run: 5\n", ":5:1", "\"shard_run\""},
        RefusedText{"Fit", kPlanHead + "fits: [{id: a, assign: [all=H7/qq6]}]\n", ":5:24",
                    "all=H7/qq6"},
        RefusedText{"TwoIds", kPlanHead + "fits: [{id: a}, {id: a}]\n", ":5:17", "twice"},
        RefusedText{"Spread", kPlanHead + "sizes: [{id: a, spread: wide}]\n", ":5:25", "wide"},
        RefusedText{"Cpk", kPlanHead + "sizes: [{id: a, spread: capability, cp: 1, cpk: 2}]\n",
                    ":5:49", "cpk"},
        RefusedText{"Friction", kPlanHead + "sizes: [{id: a, friction: [0.2, 0.1]}]\n", ":5:27",
                    "friction"},
        RefusedText{"Material",
                    kPlanHead + "materials: [{id: a, parts: [{part: all, material: moondust}]}]\n",
                    ":5:51", "moondust"},
        RefusedText{"Persons", kPlanHead + "persons: [hasty, stiff]\n", ":5:10", "persons"},
        RefusedText{"Sensitivity", kPlanHead + "method: assemble\nsensitivity: {samples: 100}\n",
                    ":6:14", "method fits"},
        RefusedText{"Shard", kPlanHead + "shard_runs: 0\n", ":5:13", "range"}),
    [](const auto& refused) { return refused.param.name; });

TEST(Plan, ListsOfOneAreThereWithoutBeingWritten) {
  const auto plan = ParsePlan(kPlanHead, "folder/plan.yaml");
  ASSERT_TRUE(plan) << plan.error().ToString();
  EXPECT_EQ(plan->CountCells(), 1);
  EXPECT_EQ(plan->CountRuns(), 10);
  EXPECT_EQ(plan->CountShards(), 1);
  EXPECT_EQ(plan->products.front(), std::filesystem::path("folder/bushing.step"));
  EXPECT_EQ(DescribeCell(*plan, FindCell(*plan, 0)), "all");
}

TEST(Plan, EachCombinationIsOneCell) {
  const auto plan = ParsePlan(kPlanHead +
                                  "fits: [{id: a, assign: [all=H7/g6]}, {id: b}]\n"
                                  "sizes: [{id: x}, {id: y, rz_um: [1, 2]}, {id: z}]\n"
                                  "shard_runs: 7\n",
                              "plan.yaml");
  ASSERT_TRUE(plan) << plan.error().ToString();
  EXPECT_EQ(plan->CountCells(), 6);
  EXPECT_EQ(plan->CountShards(), 9);  // 60 runs by 7.
  std::set<std::string> names;
  for (std::int64_t i = 0; i < plan->CountCells(); ++i) {
    names.insert(DescribeCell(*plan, FindCell(*plan, i)));
  }
  EXPECT_EQ(names.size(), 6U);
  EXPECT_EQ(DescribeCell(*plan, FindCell(*plan, 4)), "b / y");
  EXPECT_DOUBLE_EQ(units::ToUm(plan->sizes[1].roughness->high), 2);
  EXPECT_EQ(FindRuns(*plan, 8).first, 56);
  EXPECT_EQ(FindRuns(*plan, 8).end, 60);
}

}  // namespace
}  // namespace hvas::campaign
