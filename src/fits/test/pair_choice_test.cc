#include "fits/pair_choice.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/units.h"
#include "fits/fit_force.h"

namespace hvas::fits {
namespace {

constexpr double kDiameter = 40e-3;

PairToDraw MakePair(const char* fit, PairChoice choice) {
  const FitLimits limits = *CalcFitLimits(*ParseFit(fit), kDiameter);
  PairToDraw pair;
  pair.hole.zone = limits.hole;
  pair.shaft.zone = limits.shaft;
  pair.kind = limits.kind;
  pair.choice = choice;
  return pair;
}

FitForceParameters MakeRig() {
  FitForceParameters parameters;
  parameters.nominal_diameter = kDiameter;
  parameters.length = 50e-3;
  return parameters;
}

TEST(ClearanceShapeTest, IsThatOfTheLinearFunctionBetweenStations) {
  // Zero crossings at 1.5 and 2.5 of 4 intervals: 1 um of 4 um is below zero, once.
  const ClearanceShape once = CalcClearanceShape(std::vector<double>{1, 1, -1, 1, 1});
  EXPECT_EQ(once.rises, 1);
  EXPECT_DOUBLE_EQ(once.interference_share, 0.25);
  const ClearanceShape twice = CalcClearanceShape(std::vector<double>{-1, 1, -3, -1});
  EXPECT_EQ(twice.rises, 2);
  EXPECT_DOUBLE_EQ(twice.interference_share, (0.5 + 0.75 + 1) / 3);
  EXPECT_EQ(CalcClearanceShape(std::vector<double>{1, 0, 1}).rises, 0);
  EXPECT_EQ(CalcClearanceShape(std::vector<double>{}).rises, 0);
}

TEST(ShowsKindTest, TransitionNeedsTwoRisesAndAPlateauThatCanBeTold) {
  EXPECT_TRUE(ShowsKind(std::vector<double>{-1, 1, -1, 1}, FitKind::kTransition));
  EXPECT_FALSE(ShowsKind(std::vector<double>{-1, -1, 1, 1}, FitKind::kTransition));  // one rise
  // Two rises, but a plateau that nobody feels: S < 0 on nine tenths of the length.
  EXPECT_FALSE(ShowsKind(std::vector<double>{-9, -9, -9, 0.1, -9, -9, -9}, FitKind::kTransition));
  EXPECT_TRUE(ShowsKind(std::vector<double>{1, 2}, FitKind::kClearance));
  EXPECT_FALSE(ShowsKind(std::vector<double>{1, 0}, FitKind::kClearance));
  EXPECT_TRUE(ShowsKind(std::vector<double>{-1, -2}, FitKind::kInterference));
  EXPECT_FALSE(ShowsKind(std::vector<double>{-1, 0}, FitKind::kInterference));
}

TEST(DrawPairTest, W6W12EveryPairShowsTheKindOfItsFit) {
  for (const char* fit : {"H7/g6", "H7/h6", "H7/js6", "H7/k6", "H7/n6", "H7/p6", "H7/s6"}) {
    for (const PairChoice choice : {PairChoice::kOfKind, PairChoice::kOnePair}) {
      const PairToDraw pair = MakePair(fit, choice);
      for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        FitForceParameters parameters = MakeRig();
        // Mid zone of p6 is 10.75 um from contact: out of the roughness' reach, like all others.
        ASSERT_TRUE(DrawPair(pair, &random, &parameters)) << fit << " " << ToString(choice);
        EXPECT_TRUE(ShowsKind(DrawClearances(parameters), pair.kind)) << fit << " " << seed;
      }
    }
  }
}

TEST(DrawPairTest, SizesStayWithinTheirZones) {
  const PairToDraw pair = MakePair("H7/k6", PairChoice::kOfKind);
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    FitForceParameters parameters = MakeRig();
    ASSERT_TRUE(DrawPair(pair, &random, &parameters));
    EXPECT_GE(parameters.hole_diameter, kDiameter + pair.hole.zone->lower - 1e-12);
    EXPECT_LE(parameters.hole_diameter, kDiameter + pair.hole.zone->upper + 1e-12);
    EXPECT_GE(parameters.shaft_diameter, kDiameter + pair.shaft.zone->lower - 1e-12);
    EXPECT_LE(parameters.shaft_diameter, kDiameter + pair.shaft.zone->upper + 1e-12);
  }
}

TEST(DrawPairTest, OnePairHasOneSizeAndASurfaceOfItsOwnEveryTime) {
  const PairToDraw pair = MakePair("H7/k6", PairChoice::kOnePair);
  Random random(1);
  FitForceParameters first = MakeRig();
  FitForceParameters second = MakeRig();
  ASSERT_TRUE(DrawPair(pair, &random, &first));
  ASSERT_TRUE(DrawPair(pair, &random, &second));
  EXPECT_EQ(first.hole_diameter, kDiameter);
  EXPECT_EQ(first.shaft_diameter, kDiameter);
  EXPECT_EQ(second.hole_diameter, kDiameter);
  EXPECT_NE(DrawClearances(first), DrawClearances(second));
}

TEST(DrawPairTest, SaysSoWhereTheSurfaceIsRougherThanTheFit) {
  Random random(1);
  FitForceParameters parameters = MakeRig();
  parameters.roughness = 200e-6;  // +-100 um, radial, against a clearance of 4.5 to 25 um
  EXPECT_FALSE(DrawPair(MakePair("H7/g6", PairChoice::kOfKind), &random, &parameters));
}

TEST(DrawPairTest, W1MeasuredDiametersStay) {  // b
  Random random(1);
  FitForceParameters parameters = MakeRig();
  parameters.hole_diameters = {{0, 40.010e-3}, {50e-3, 40.020e-3}};
  parameters.shaft_diameters = {{0, 39.990e-3}};
  ASSERT_TRUE(DrawPair(MakePair("H7/g6", PairChoice::kOfKind), &random, &parameters));
  const FitForce fit = *FitForce::Make(parameters);
  EXPECT_NEAR(fit.CalcClearance(0), 10e-6, 3.15e-6);
  EXPECT_NEAR(fit.CalcClearance(50e-3), 15e-6, 3.15e-6);
  EXPECT_NEAR(fit.mean_clearance(), 12.5e-6, 1e-12);
}

}  // namespace
}  // namespace hvas::fits
