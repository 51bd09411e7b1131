#include "simulation/model_limits.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "haptics/mate_guide.h"
#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

constexpr std::size_t kPeg = 1;

/** The model of the peg in the block, with the peg's first mate of a kind listed so often. */
Model MakeModelWithMates(product::MateKind kind, std::size_t count) {
  Model model = *testing::PegInBlockModel();
  const auto& mates = model.product->mates;
  const auto mate = std::find_if(mates.begin(), mates.end(),
                                 [kind](const product::Mate& other) { return other.kind == kind; });
  model.mates_of[kPeg].assign(count, mate->id);
  return model;
}

std::vector<std::string> ListCodes(const Model& model) {
  Diagnostics diagnostics;
  ReportModelLimits(model, &diagnostics);
  std::vector<std::string> codes;
  for (const Diagnostic& item : diagnostics.items()) {
    EXPECT_FALSE(item.entity.empty());
    codes.push_back(item.code);
  }
  return codes;
}

using Codes = std::vector<std::string>;

TEST(ModelLimitsTest, OrdinaryProductReachesNone) {
  EXPECT_EQ(ListCodes(*testing::PegInBlockModel()), Codes());
}

TEST(ModelLimitsTest, MatesThatDoNotGuideTheHeldPartAreReported) {
  constexpr std::size_t kMost = haptics::MateGuide::kMaxMates;
  const auto kStop = product::MateKind::kFaceFace;  // The floor of the bore.
  EXPECT_EQ(ListCodes(MakeModelWithMates(kStop, kMost)), Codes());
  EXPECT_EQ(ListCodes(MakeModelWithMates(kStop, kMost + 1)), Codes{"limit-mates"});
}

TEST(ModelLimitsTest, PairsOfFacesThatShareAMarkAreReported) {
  const auto kGuide = product::MateKind::kAxisHole;
  EXPECT_EQ(ListCodes(MakeModelWithMates(kGuide, 4)), Codes());
  EXPECT_EQ(ListCodes(MakeModelWithMates(kGuide, 5)), Codes{"limit-face-pairs"});
}

TEST(ModelLimitsTest, PartsThatWeighNextToNothingAreReportedOnce) {
  product::Product product = testing::PegInBlock();
  for (product::Part& part : product.parts) {
    part.mass.mass = 0.05e-3;
  }
  Diagnostics diagnostics;
  const auto model = Compile(std::make_shared<product::Product>(std::move(product)),
                             testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  const auto& items = diagnostics.items();
  const auto found = std::find_if(items.begin(), items.end(),
                                  [](const Diagnostic& d) { return d.code == "limit-mass"; });
  ASSERT_NE(found, items.end());
  EXPECT_EQ(found->entity, "block");
  EXPECT_EQ(found->message,
            "it and 1 other part move in the hand and on the table as if it weighed 0.1 g, with "
            "the inertia of a ball, because it weighs less");
  EXPECT_EQ(std::count_if(items.begin(), items.end(),
                          [](const Diagnostic& d) { return d.code == "limit-mass"; }),
            1);
}

}  // namespace
}  // namespace hvas::simulation
