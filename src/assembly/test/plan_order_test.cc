#include "assembly/plan_order.h"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "assembly/prepare_model.h"
#include "orders/order_rules.h"
#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using orders::OrderRules;
using product::OccurrenceId;
using simulation::Model;

class CheckOrderTest : public ::testing::Test {
 protected:
  CheckOrderTest() {
    Diagnostics diagnostics;
    auto model = PrepareModel(simulation::testing::CappedCollarUnderClamp(), {}, &diagnostics);
    model_ = model.value_or(nullptr);
    rules_ = orders::FindOrderRules(*model_, {});
  }

  [[nodiscard]] OccurrenceId Find(const std::string& name) const {
    const auto& all = model_->product->occurrences;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
    return found->id;
  }

  [[nodiscard]] std::string NameOf(std::size_t move) const {
    return model_->product->occurrences[rules_.moves[move].parts.front().index()].name;
  }

  [[nodiscard]] Result<CheckedOrder> Check(const std::vector<std::string>& names) const {
    std::vector<OccurrenceId> parts;
    for (const std::string& name : names) {
      parts.push_back(Find(name));
    }
    return CheckOrder(*model_, rules_, parts, {});
  }

  std::shared_ptr<const Model> model_;
  OrderRules rules_;
};

TEST_F(CheckOrderTest, AnOrderThatIsPossibleHasItsCostAndItsSteps) {
  const auto plan = PlanOrder(*model_, {});
  ASSERT_TRUE(plan.has_value()) << plan.error().ToString();
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"peg", "clamp", "cap"}, {"peg", "cap", "clamp"}}) {
    const auto checked = Check(names);
    ASSERT_TRUE(checked.has_value()) << checked.error().ToString();
    ASSERT_TRUE(checked->order.has_value());
    EXPECT_GE(checked->order->cost, plan->search.orders.front().cost);
    EXPECT_EQ(checked->order->counts, orders::CountOrder(rules_, *checked->order));
    const auto steps = orders::ListSteps(rules_, *checked->order);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto& step = steps[steps.size() - names.size() + i];
      EXPECT_EQ(step.occurrence, Find(names[i]));
      EXPECT_TRUE(checked->blocking[i].empty());
    }
    ASSERT_TRUE(checked->statics.has_value());
    EXPECT_EQ(checked->statics->holds.size(), names.size());
  }
}

TEST_F(CheckOrderTest, WhatStandsInTheWayIsNamed) {
  const auto checked = Check({"clamp", "peg", "cap"});
  ASSERT_TRUE(checked.has_value()) << checked.error().ToString();
  EXPECT_FALSE(checked->order.has_value());
  EXPECT_FALSE(checked->statics.has_value());
  EXPECT_TRUE(checked->blocking[0].empty());
  ASSERT_EQ(checked->blocking[1].size(), 1U);
  EXPECT_EQ(NameOf(checked->blocking[1].front()), "clamp");
  EXPECT_EQ(NameOf(checked->moves[1]), "peg");
}

TEST_F(CheckOrderTest, AllPartsHaveToBeThereOnce) {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"peg", "clamp"},
                                                {"peg", "clamp", "cap", "peg"},
                                                {"block", "peg", "clamp", "cap"},
                                                {}}) {
    const auto checked = Check(names);
    ASSERT_FALSE(checked.has_value());
    EXPECT_EQ(checked.error().code, ErrorCode::kInvalid);
  }
  const auto none = CheckOrder(*model_, rules_, {OccurrenceId(1000), OccurrenceId()}, {});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kInvalid);
}

}  // namespace
}  // namespace hvas::assembly
