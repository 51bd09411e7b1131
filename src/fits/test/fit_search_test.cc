#include "fits/fit_search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

std::vector<FoundFit> Find(double nominal_mm, double min_um, double max_um,
                           FitBasis basis = FitBasis::kHole) {
  return *FindFits(units::FromMm(nominal_mm), units::FromUm(min_um), units::FromUm(max_um), basis);
}

// N4: asked for exactly what H7/g6 gives at 40 mm, it is found and comes first.
TEST(FitSearch, TheFitWhoseLimitsAreAskedForComesFirst) {
  EXPECT_EQ(Find(40, 9, 50).front().fit.ToString(), "H7/g6");
  EXPECT_NEAR(Find(40, 9, 50).front().unused, 0, 1e-12);
  EXPECT_EQ(Find(40, -42, -1).front().fit.ToString(), "H7/p6");
  EXPECT_EQ(Find(40, 9, 50, FitBasis::kShaft).front().fit.ToString(), "G7/h6");
}

// Everything found lies in the range, and a wider range loses nothing.
TEST(FitSearch, FindsAllAndOnlyWhatLiesInTheRange) {
  for (const double nominal_mm : {1.0, 3.0, 25.0, 40.0, 180.0, 500.0, 1200.0}) {
    const auto narrow = Find(nominal_mm, -30, 60);
    const auto wide = Find(nominal_mm, -60, 90);
    for (const FoundFit& found : narrow) {
      EXPECT_GE(found.limits.min_clearance, -30.0001e-6);
      EXPECT_LE(found.limits.max_clearance, 60.0001e-6);
      EXPECT_TRUE(std::any_of(wide.begin(), wide.end(), [&](const FoundFit& other) {
        return other.fit.ToString() == found.fit.ToString();
      }));
    }
    EXPECT_GE(wide.size(), narrow.size());
    EXPECT_TRUE(std::is_sorted(narrow.begin(), narrow.end(), [](const auto& a, const auto& b) {
      return a.is_common > b.is_common;
    }));
  }
}

TEST(FitSearch, RefusesAnEmptyRangeAndSizesBeyondTheStandard) {
  EXPECT_FALSE(FindFits(0.04, 50e-6, 9e-6, FitBasis::kHole));
  EXPECT_FALSE(FindFits(4.0, 0, 1e-4, FitBasis::kHole));
  EXPECT_TRUE(Find(40, 0, 1).empty());
}

}  // namespace
}  // namespace hvas::fits
