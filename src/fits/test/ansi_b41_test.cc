#include "fits/ansi_b41.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

double FromInch(double inches) {
  return inches * units::kMetresPerInch;
}

double ToThou(double length) {
  return 1e3 * length / units::kMetresPerInch;
}

/** Least and largest clearance as the public tables print them beside the limits, in thousandths of
 an inch; negative is interference. They are read from another column than the limits. */
struct PrintedClearance {
  const char* name;
  std::vector<double> ends;  // The ends of the ranges [in].
  std::vector<double> least;
  std::vector<double> largest;
};

const std::vector<double> kSizeEnds{0.12, 0.24, 0.40, 0.71,  1.19,  1.97, 3.15,
                                    4.73, 7.09, 9.85, 12.41, 15.75, 19.69};
const std::vector<double> kForceEnds{0.12, 0.24, 0.40, 0.56, 0.71, 0.95,
                                     1.19, 1.58, 1.97, 2.56, 3.15};

// clang-format off
const std::vector<PrintedClearance> kPrintedClearances{
    {"RC1", kSizeEnds, {0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.4, 0.5, 0.6, 0.6, 0.8, 1.0, 1.2},
     {0.45, 0.5, 0.6, 0.75, 0.95, 1.1, 1.2, 1.5, 1.8, 2.0, 2.3, 2.7, 3.0}},
    {"RC2", kSizeEnds, {0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.4, 0.5, 0.6, 0.6, 0.8, 1.0, 1.2},
     {0.55, 0.65, 0.85, 0.95, 1.2, 1.4, 1.6, 2.0, 2.3, 2.6, 2.9, 3.4, 3.8}},
    {"RC3", kSizeEnds, {0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.5, 3.0, 4.0},
     {0.95, 1.2, 1.5, 1.7, 2.1, 2.6, 3.1, 3.7, 4.2, 5.0, 5.7, 6.6, 8.1}},
    {"RC4", {kSizeEnds.begin(), kSizeEnds.end() - 1}, {0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 2.0, 2.5, 3.0},
     {1.3, 1.6, 2.0, 2.3, 2.8, 3.6, 4.2, 5.0, 5.7, 6.6, 7.5, 8.7}},
    {"RC5", {kSizeEnds.begin(), kSizeEnds.begin() + 10}, {0.6, 0.8, 1.0, 1.2, 1.6, 2.0, 2.5, 3.0, 3.5, 4.0},
     {1.6, 2.0, 2.5, 2.9, 3.6, 4.6, 5.5, 6.6, 7.6, 8.6}},
    {"RC6", {kSizeEnds.begin(), kSizeEnds.begin() + 8}, {0.6, 0.8, 1.0, 1.2, 1.6, 2.0, 2.5, 3.0},
     {2.2, 2.7, 3.3, 3.8, 4.8, 6.1, 7.3, 8.7}},
    {"RC7", {kSizeEnds.begin(), kSizeEnds.begin() + 7}, {1.0, 1.2, 1.6, 2.0, 2.5, 3.0, 4.0},
     {2.6, 3.1, 3.9, 4.6, 5.7, 7.1, 8.8}},
    {"RC8", {kSizeEnds.begin(), kSizeEnds.begin() + 4}, {2.5, 2.8, 3.0, 3.5}, {5.1, 5.8, 6.6, 7.9}},
    {"RC9", kSizeEnds, {4.0, 4.5, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 15.0, 18.0, 22.0, 25.0},
     {8.1, 9.0, 10.7, 12.8, 15.5, 18.0, 20.5, 24.0, 28.0, 34.0, 38.0, 45.0, 51.0}},
    {"LN1", kSizeEnds, {-0.45, -0.5, -0.65, -0.8, -1.0, -1.1, -1.3, -1.6, -1.9, -2.2, -2.3, -2.6, -2.8},
     {0, 0, 0, 0, 0, 0, -0.1, -0.1, -0.2, -0.2, -0.2, -0.2, -0.2}},
    {"LN2", kSizeEnds, {-0.65, -0.8, -1.0, -1.1, -1.3, -1.6, -2.1, -2.5, -2.8, -3.2, -3.4, -3.9, -4.4},
     {0, 0, 0, 0, 0, 0, -0.2, -0.2, -0.2, -0.2, -0.2, -0.3, -0.3}},
    {"LN3", kSizeEnds, {-0.75, -0.9, -1.2, -1.4, -1.7, -2.0, -2.3, -2.9, -3.5, -4.2, -4.7, -5.9, -6.6},
     {-0.1, -0.1, -0.2, -0.3, -0.4, -0.4, -0.4, -0.6, -0.9, -1.2, -1.5, -2.3, -2.5}},
    {"FN1", kForceEnds, {-0.5, -0.6, -0.75, -0.8, -0.9, -1.1, -1.2, -1.3, -1.4, -1.8, -1.9},
     {-0.05, -0.1, -0.1, -0.1, -0.2, -0.2, -0.3, -0.3, -0.4, -0.6, -0.7}},
    {"FN2", kForceEnds, {-0.85, -1.0, -1.4, -1.6, -1.6, -1.9, -1.9, -2.4, -2.4, -2.7, -2.9},
     {-0.2, -0.2, -0.4, -0.5, -0.5, -0.6, -0.6, -0.8, -0.8, -0.8, -1.0}},
    {"FN3", {kForceEnds.begin() + 6, kForceEnds.end()}, {-2.1, -2.6, -2.8, -3.2, -3.7}, {-0.8, -1.0, -1.2, -1.3, -1.8}},
    {"FN4", kForceEnds, {-0.95, -1.2, -1.6, -1.8, -1.8, -2.1, -2.3, -3.1, -3.4, -4.2, -4.7},
     {-0.3, -0.4, -0.6, -0.7, -0.7, -0.8, -1.0, -1.5, -1.8, -2.3, -2.8}},
    {"FN5", kForceEnds, {-1.3, -1.7, -2.0, -2.3, -2.5, -3.0, -3.3, -4.0, -5.0, -6.2, -7.2},
     {-0.3, -0.5, -0.5, -0.6, -0.8, -1.0, -1.3, -1.4, -2.4, -3.2, -4.2}},
};

// clang-format on

TEST(AnsiB41, GivesTheClearancesThatAreTabulatedBesideTheLimits) {
  std::size_t checked = 0;
  for (const PrintedClearance& printed : kPrintedClearances) {
    ASSERT_EQ(printed.ends.size(), printed.least.size()) << printed.name;
    ASSERT_EQ(printed.ends.size(), printed.largest.size()) << printed.name;
    for (std::size_t i = 0; i < printed.ends.size(); ++i) {
      const auto fit = FindAnsiFit(printed.name, FromInch(printed.ends[i]));
      ASSERT_TRUE(fit) << fit.error().ToString();
      EXPECT_NEAR(ToThou(fit->limits.min_clearance), printed.least[i], 1e-9) << printed.name << i;
      EXPECT_NEAR(ToThou(fit->limits.max_clearance), printed.largest[i], 1e-9) << printed.name << i;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 181U);
}

TEST(AnsiB41, GrowsWithTheSizeAndHasEachToleranceOverZero) {
  for (const PrintedClearance& printed : kPrintedClearances) {
    double last = 0;
    for (const double end : kSizeEnds) {
      const auto fit = FindAnsiFit(printed.name, FromInch(end));
      if (!fit) {
        continue;
      }
      const FitLimits& limits = fit->limits;
      EXPECT_GT(limits.hole.upper, limits.hole.lower);
      EXPECT_GT(limits.shaft.upper, limits.shaft.lower);
      const double spread = limits.max_clearance - limits.min_clearance;
      EXPECT_GE(spread, last - 1e-12) << printed.name << " " << end;
      last = spread;
    }
  }
}

TEST(AnsiB41, ARangeIsOverItsBeginningUpToItsEnd) {
  EXPECT_NEAR(ToThou(FindAnsiFit("RC4", FromInch(1.19))->limits.max_clearance), 2.8, 1e-9);
  EXPECT_NEAR(ToThou(FindAnsiFit("RC4", FromInch(1.1901))->limits.max_clearance), 3.6, 1e-9);
}

TEST(AnsiB41, NamesAreReadAsPeopleWriteThem) {
  for (const char* name : {"RC4", "rc4", "RC 4", "RC-4"}) {
    EXPECT_TRUE(IsAnsiFit(name)) << name;
    EXPECT_EQ(FindAnsiFit(name, FromInch(1))->name, "RC4");
  }
  for (const char* name : {"H7/g6", "RC", "R4", "RC4/5", "C45", "", "k6"}) {
    EXPECT_FALSE(IsAnsiFit(name)) << name;
  }
}

TEST(AnsiB41, WhatIsNotTabulatedIsRefusedWithTheReason) {
  EXPECT_EQ(FindAnsiFit("LC5", FromInch(1)).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(FindAnsiFit("RC10", FromInch(1)).error().code, ErrorCode::kNotFound);
  for (const auto& [name, inches] :
       {std::pair("RC4", 20.0), std::pair("FN2", 3.2), std::pair("FN3", 0.9), std::pair("RC4", 0.0),
        std::pair("RC4", -1.0)}) {
    const auto fit = FindAnsiFit(name, FromInch(inches));
    ASSERT_FALSE(fit) << name << inches;
    EXPECT_EQ(fit.error().code, ErrorCode::kUnsupported);
    EXPECT_FALSE(fit.error().remedy.empty());
  }
}

}  // namespace
}  // namespace hvas::fits
