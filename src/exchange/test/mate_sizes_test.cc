#include "exchange/mate_sizes.h"

#include <gtest/gtest.h>

namespace hvas::exchange {
namespace {

product::Mate ShaftInHole(const std::string& code) {
  product::Mate mate;
  mate.kind = product::MateKind::kAxisHole;
  mate.hole_radius = 20e-3;
  mate.shaft_radius = 20e-3;
  mate.fit = product::Fit{product::FitKind::kClearance, code, 40e-3, true, ""};
  return mate;
}

TEST(MateSizesTest, AreTheMiddleOfWhatTheFitAllows) {
  const auto sizes = CalcMateSizes(ShaftInHole("H7/g6"));  // 0 +25 um, -25 -9 um.
  ASSERT_TRUE(sizes.has_value());
  EXPECT_NEAR(sizes->hole, 40.0125e-3, 1e-12);
  EXPECT_NEAR(sizes->shaft, 39.983e-3, 1e-12);
  EXPECT_NEAR(sizes->min_clearance, 9e-6, 1e-12);
  EXPECT_NEAR(sizes->max_clearance, 50e-6, 1e-12);
}

TEST(MateSizesTest, MeasuredOnesComeFirst) {
  product::Mate mate = ShaftInHole("H7/g6");
  mate.conditions.hole_diameters = {{0, 40.02e-3}, {10e-3, 40.04e-3}};
  EXPECT_NEAR(CalcMateSizes(mate)->hole, 40.03e-3, 1e-12);
  EXPECT_NEAR(CalcMateSizes(mate)->shaft, 39.983e-3, 1e-12);
  mate.conditions.shaft_diameters = {{0, 39.99e-3}};
  EXPECT_NEAR(CalcMateSizes(mate)->min_clearance, 40e-6, 1e-12);
  EXPECT_NEAR(CalcMateSizes(mate)->max_clearance, 40e-6, 1e-12);
}

TEST(MateSizesTest, AreAsDrawnWithoutAClassAndNoneForThreadsAndPlanes) {
  product::Mate mate = ShaftInHole("");
  mate.hole_radius = 20.5e-3;
  EXPECT_NEAR(CalcMateSizes(mate)->clearance(), 1e-3, 1e-12);
  mate.fit->kind = product::FitKind::kThread;
  EXPECT_FALSE(CalcMateSizes(mate).has_value());
  mate.fit.reset();
  EXPECT_FALSE(CalcMateSizes(mate).has_value());
}

}  // namespace
}  // namespace hvas::exchange
