#include "base/units.h"

#include <gtest/gtest.h>

namespace hvas::units {
namespace {

TEST(Units, ConvertToSi) {
  EXPECT_DOUBLE_EQ(FromMm(25.4), kMetresPerInch);
  EXPECT_DOUBLE_EQ(FromUm(1000), FromMm(1));
  EXPECT_DOUBLE_EQ(FromMm3(1e9), 1.0);
  EXPECT_DOUBLE_EQ(FromDeg(180), std::numbers::pi);
  EXPECT_DOUBLE_EQ(FromGpa(0.21), FromMpa(210));
}

TEST(Units, ComeBackUnchanged) {
  for (const double value : {-3.7, 0.0, 1e-3, 12.5, 4096.1}) {
    EXPECT_DOUBLE_EQ(ToMm(FromMm(value)), value);
    EXPECT_DOUBLE_EQ(ToUm(FromUm(value)), value);
    EXPECT_DOUBLE_EQ(ToDeg(FromDeg(value)), value);
    EXPECT_DOUBLE_EQ(ToMm3(FromMm3(value)), value);
    EXPECT_DOUBLE_EQ(ToMpa(FromMpa(value)), value);
  }
}

}  // namespace
}  // namespace hvas::units
