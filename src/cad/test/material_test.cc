#include "cad/material.h"

#include <gtest/gtest.h>

namespace hvas::cad {
namespace {

TEST(NormaliseDensity, ReadsSteelInEveryUnitThatFilesUse) {
  for (const double value : {7850.0, 7.85, 7.85e-3, 7.85e-6}) {
    ASSERT_TRUE(NormaliseDensity(value).has_value()) << value;
    EXPECT_NEAR(*NormaliseDensity(value), 7850, 1e-9);
  }
}

TEST(NormaliseDensity, ReadsTheLightestAndHeaviestMaterials) {
  EXPECT_NEAR(NormaliseDensity(0.45).value_or(0), 450, 1e-9);
  EXPECT_NEAR(NormaliseDensity(22.59).value_or(0), 22590, 1e-9);
}

TEST(NormaliseDensity, RejectsWhatNoUnitExplains) {
  for (const double value : {0.0, -7.85, 235.0, 1e6, 0.1}) {
    EXPECT_FALSE(NormaliseDensity(value).has_value()) << value;
  }
}

}  // namespace
}  // namespace hvas::cad
