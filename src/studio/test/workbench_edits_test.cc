#include "studio/workbench_edits.h"

#include <cstddef>

#include <gtest/gtest.h>

#include "studio/test/workbench_fixture.h"

namespace hvas::studio {
namespace {

using simulation::Placement;
using testing::kPeg;

class WorkbenchEditsTest : public testing::WorkbenchFixture {};

TEST_F(WorkbenchEditsTest, WhatWasDoneIsUndoneAndDoneAgain) {
  OpenPeg();
  const Vec3 p_before = bench_.live().state().parts[kPeg].X_WB.p();
  TakePeg();
  InsertPeg();
  ASSERT_FALSE(HasFatalFailure());
  ReleasePeg();
  ASSERT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
  const auto history = log_.Await(
      [](const Json& event) { return event["event"] == "history" && event["undo"].is_string(); });
  ASSERT_TRUE(history);
  EXPECT_EQ((*history)["undo"], "insert peg");
  std::size_t start = log_.size();
  ASSERT_TRUE(bench_.edits().Undo());
  EXPECT_TRUE(AwaitPlacementEvent("loose", start));
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kLoose));
  EXPECT_LT((bench_.live().state().parts[kPeg].X_WB.p() - p_before).norm(), 1e-3);
  start = log_.size();
  ASSERT_TRUE(bench_.edits().Redo());
  EXPECT_TRUE(AwaitPlacementEvent("placed", start));
  EXPECT_TRUE(AwaitPlacement(kPeg, Placement::kPlaced));
}

TEST_F(WorkbenchEditsTest, ChangeOfTheProductIsCompiledAndUndone) {
  OpenPeg();
  const auto before = bench_.live().scene();
  ASSERT_FALSE(before->model->product->mates.empty());
  EXPECT_FALSE(bench_.edits().Change({"nothing", nullptr, [](product::Product*) -> Result<void> {
                                        return Fail(ErrorCode::kInvalid, "no", "", "");
                                      }}));
  std::size_t start = log_.size();
  ASSERT_TRUE(
      bench_.edits().Change({"change", nullptr, [](product::Product* product) -> Result<void> {
                               product->name = "changed";
                               return {};
                             }}));
  EXPECT_EQ((*log_.Await("scene", start))["why"], "change");
  EXPECT_EQ(bench_.live().scene()->model->product->name, "changed");
  EXPECT_EQ(before->model->product->name, "rig");  // a model is compiled, never edited
  ASSERT_TRUE(log_.AwaitTrue([&] { return bench_.live().state().parts.size() == 2; }));
  start = log_.size();
  ASSERT_TRUE(bench_.edits().Undo());
  EXPECT_EQ((*log_.Await("scene", start))["why"], "undone");
  EXPECT_EQ(bench_.live().scene(), before);
}

}  // namespace
}  // namespace hvas::studio
