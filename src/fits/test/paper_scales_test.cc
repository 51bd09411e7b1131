#include "fits/paper_scales.h"

#include <gtest/gtest.h>

#include "fits/fit_force.h"

namespace hvas::fits {
namespace {

FitForceParameters PaperRig(double interference) {
  FitForceParameters p;
  p.nominal_diameter = p.hole_diameter = 0.04;
  p.shaft_diameter = 0.04 + interference;
  p.length = 0.05;
  return p;
}

// W10: the rig's mean interference is shown with 6 N; fits-and-insertion 2.4 has k_r 1.504e-4.
TEST(PaperScales, FactorOfTheInterferenceFitBelongsToItsMean) {
  FitForceParameters p = PaperRig(21.5e-6);
  p.roughness = 0;
  const PaperScale& scale = FindPaperScale(FitKind::kInterference);
  EXPECT_NEAR(FitForce::Make(p)->max_resistance(), scale.true_force, 0.1);
  EXPECT_NEAR(scale.factor, 1.504e-4, 1e-7);
  EXPECT_DOUBLE_EQ(scale.factor * scale.true_force, 6);
}

// W10: hole and shaft of one size, roughness alone: 4 N in the mean of many.
TEST(PaperScales, FactorOfTheTransitionFitBelongsToEqualSizes) {
  FitForceParameters p = PaperRig(0);
  double sum = 0;
  constexpr int kPairs = 20'000;
  for (int i = 0; i < kPairs; ++i) {
    p.seed = static_cast<std::uint64_t>(i);
    sum += FitForce::Make(p)->max_resistance();
  }
  const PaperScale& scale = FindPaperScale(FitKind::kTransition);
  EXPECT_NEAR(sum / kPairs * scale.factor, 4, 0.04);
}

TEST(PaperScales, AnotherPairIsShownAtTheEndOfItsRange) {
  EXPECT_DOUBLE_EQ(CalcPaperFactor(FitKind::kInterference, 77931) * 77931, 6);
  EXPECT_DOUBLE_EQ(CalcPaperFactor(FitKind::kTransition, 632) * 632, 4);
  EXPECT_EQ(CalcPaperFactor(FitKind::kClearance, 0.2), 1);
  EXPECT_EQ(CalcPaperFactor(FitKind::kTransition, 0), FindPaperScale(FitKind::kTransition).factor);
}

}  // namespace
}  // namespace hvas::fits
