#include "shopfloor/work_plan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "assembly/prepare_model.h"
#include "shopfloor/dfa_rating.h"
#include "shopfloor/instruction_page.h"
#include "shopfloor/most_sequence.h"
#include "shopfloor/motion_code.h"
#include "shopfloor/work_animation.h"
#include "simulation/test/small_models.h"

namespace hvas::shopfloor {
namespace {

using simulation::Model;

/** A product with its plan. */
struct Planned {
  std::shared_ptr<const Model> model;
  assembly::OrderPlan plan;
};

Planned MakePlanned(const product::Product& product) {
  Diagnostics diagnostics;
  auto model = assembly::PrepareModel(product, {}, &diagnostics);
  EXPECT_TRUE(model);
  auto plan = assembly::PlanOrder(**model, {});
  EXPECT_TRUE(plan);
  return {*model, std::move(*plan)};
}

const Planned& Capped() {
  static const Planned planned = MakePlanned(simulation::testing::CappedCollarUnderClamp());
  return planned;
}

TEST(WorkPlanTest, EachPartComesOnce) {
  const WorkPlan plan = MakeWorkPlan(*Capped().model, Capped().plan);
  std::vector<product::OccurrenceId> come;
  for (const WorkStep& step : plan.steps) {
    if (step.kind != WorkStep::Kind::kLayAside) {
      EXPECT_EQ(std::find(come.begin(), come.end(), step.leading.front()), come.end());
      come.insert(come.end(), step.coming.begin(), step.coming.end());
    }
  }
  EXPECT_EQ(come.size() + plan.left_out.size(), Capped().model->bodies.size());
  int billed = 0;
  for (const BillLine& line : plan.bill) {
    billed += line.count;
  }
  EXPECT_EQ(billed, static_cast<int>(Capped().model->bodies.size()));
}

TEST(WorkPlanTest, MotionsAddUpAndAreCodesOfModapts) {
  const WorkPlan plan = MakeWorkPlan(*Capped().model, Capped().plan);
  int all = 0;
  for (const WorkStep& step : plan.steps) {
    EXPECT_EQ(orders::SumMods(step.motions), step.mods);
    for (const orders::HandMotion& motion : step.motions) {
      const auto coded = ParseMotions(motion.code, ModaptsCard());
      ASSERT_TRUE(coded) << motion.code;
      EXPECT_NEAR(SumSeconds(*coded), orders::kModSeconds * motion.mods, 1e-9) << motion.code;
      for (const Language language : {Language::kEnglish, Language::kGerman}) {
        EXPECT_FALSE(DescribeMotion(motion, language).empty());
      }
    }
    all += step.mods;
  }
  EXPECT_EQ(all, plan.mods);
  EXPECT_GT(all, 0);
}

TEST(MostSequenceTest, FollowsTheMotions) {
  using orders::HandMotion;
  using orders::MotionPurpose;
  const std::vector<HandMotion> screw{
      {MotionPurpose::kGoTo, "M4", 4, 0.3},       {MotionPurpose::kGet, "E2 G3", 5, 0.01},
      {MotionPurpose::kBring, "M4", 4, 0.3},      {MotionPurpose::kPut, "E2 P5", 7, 0},
      {MotionPurpose::kToolOn, "M3 E2 P2", 7, 0}, {MotionPurpose::kCrank, "10 C3", 30, 10}};
  const std::vector<MostSequence> sequences = ListMostSequences(screw);
  ASSERT_EQ(sequences.size(), 2U);
  EXPECT_EQ(sequences[0].code, "A1 B0 G3 A1 B0 P6 A0") << "pick a screw and insert it: 110 TMU";
  EXPECT_NEAR(sequences[0].seconds, 3.96, 1e-12);
  EXPECT_EQ(sequences[1].code, "A1 B0 G1 A1 B0 P3 F16 A1 B0 P1 A0") << "3.87 s of turns: F 16";
  EXPECT_TRUE(ListMostSequences({}).empty());
}

TEST(InstructionPageTest, HasEveryStepInItsLanguageAndTheSameBytes) {
  const WorkPlan plan = MakeWorkPlan(*Capped().model, Capped().plan);
  InstructionOptions options;
  options.language = Language::kGerman;
  options.head = "<b>ACME</b>";
  const auto page = MakeInstructionPage(*Capped().model, plan, options);
  ASSERT_TRUE(page);
  EXPECT_NE(page->find("<html lang=\"de\">"), std::string::npos);
  EXPECT_NE(page->find("<b>ACME</b>"), std::string::npos);
  EXPECT_NE(page->find("Stückliste"), std::string::npos);
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    EXPECT_NE(page->find("id=\"step-" + std::to_string(i + 1) + "\""), std::string::npos);
  }
  EXPECT_EQ(page->find("{}"), std::string::npos) << "a word was not put in";
  EXPECT_EQ(*MakeInstructionPage(*Capped().model, plan, options), *page);
}

TEST(InstructionPageTest, NamesAreNoMarkup) {
  product::Product product = simulation::testing::CappedCollarUnderClamp();
  product.name = "<script>alert(1)</script>";
  for (product::Occurrence& occurrence : product.occurrences) {
    occurrence.name = "<img src=x onerror=alert(1)>&\"" + occurrence.name;
  }
  const Planned planned = MakePlanned(product);
  const WorkPlan plan = MakeWorkPlan(*planned.model, planned.plan);
  const auto page = MakeInstructionPage(*planned.model, plan, {});
  ASSERT_TRUE(page);
  EXPECT_EQ(page->find("<script>alert"), std::string::npos);
  EXPECT_EQ(page->find("<img src=x"), std::string::npos);
}

TEST(InstructionPageTest, AStopEndsIt) {
  const WorkPlan plan = MakeWorkPlan(*Capped().model, Capped().plan);
  std::stop_source stop;
  stop.request_stop();
  InstructionOptions options;
  options.stop = stop.get_token();
  const auto page = MakeInstructionPage(*Capped().model, plan, options);
  ASSERT_FALSE(page);
  EXPECT_EQ(page.error().code, ErrorCode::kCancelled);
}

TEST(WorkAnimationTest, IsABinaryGltfWithOneAnimation) {
  const WorkPlan plan = MakeWorkPlan(*Capped().model, Capped().plan);
  const auto glb = MakeWorkAnimation(*Capped().model, plan);
  ASSERT_TRUE(glb);
  EXPECT_EQ(glb->substr(0, 4), "glTF");
  EXPECT_NE(glb->find("\"animations\""), std::string::npos);
  EXPECT_NE(glb->find("\"translation\""), std::string::npos);
}

TEST(DfaRatingTest, RatesEachPartAndReckonsWhatAdviceSaves) {
  const auto rating = RateAssembly(*Capped().model, Capped().plan);
  ASSERT_TRUE(rating);
  EXPECT_EQ(rating->sheet.parts, static_cast<int>(Capped().model->bodies.size()));
  EXPECT_GE(rating->sheet.min_parts, 1);
  EXPECT_EQ(rating->groups.size(), rating->sheet.rows.size());
  EXPECT_TRUE(rating->groups.front().need.is_first);
  for (const DfaAdvice& advice : rating->advice) {
    EXPECT_GT(advice.seconds, 0);
    EXPECT_LE(advice.seconds, rating->sheet.seconds);
  }
}

}  // namespace
}  // namespace hvas::shopfloor
