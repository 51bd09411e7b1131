#include "shopfloor/motion_code.h"

#include <gtest/gtest.h>

namespace hvas::shopfloor {
namespace {

double SecondsOf(const char* sequence) {
  const auto motions = ParseMotions(sequence, ModaptsCard());
  EXPECT_TRUE(motions) << (motions ? "" : motions.error().ToString());
  return motions ? SumSeconds(*motions) : -1;
}

// Worked examples of two public programs (docs/references.md).
TEST(MotionCodeTest, ModaptsExamplesAreExact) {
  EXPECT_NEAR(SecondsOf("M3+E2+G3+M3+E2+P5"), 2.322, 1e-12) << "a screw, tight: 18 MOD";
  EXPECT_NEAR(SecondsOf("M3 E2 G3 M3 E2 P2"), 1.935, 1e-12) << "loose: 15 MOD";
  EXPECT_NEAR(SecondsOf("M3E2G3M3P0"), 1.419, 1e-12) << "about there: 11 MOD";
  EXPECT_NEAR(SecondsOf("M4G1 M4P5 E2"), 2.064, 1e-12) << "a bracket: 16 MOD";
  EXPECT_NEAR(SecondsOf("M4G1 M3P2"), 1.29, 1e-12) << "get and put: 10 MOD";
}

TEST(MotionCodeTest, AMotionMayBeDoneSeveralTimes) {
  const auto motions = ParseMotions("5 C3 + A4", ModaptsCard());
  ASSERT_TRUE(motions);
  ASSERT_EQ(motions->size(), 2U);
  EXPECT_EQ((*motions)[0].count, 5);
  EXPECT_NEAR(SumSeconds(*motions), 19 * 0.129, 1e-12);
  EXPECT_NEAR(SecondsOf("W2.36"), 2.36 * 0.129, 1e-12);
}

TEST(MotionCodeTest, SaysWhereThereIsNoCode) {
  for (const char* bad :
       {"M45", "Q1", "M3 E2 G", "3", "0 M3", "2 3 M4", "M3,E2", "99999999999 M3"}) {
    const auto motions = ParseMotions(bad, ModaptsCard());
    ASSERT_FALSE(motions) << bad;
    EXPECT_EQ(motions.error().code, ErrorCode::kInvalid);
    EXPECT_NE(motions.error().message.find("character"), std::string::npos) << bad;
  }
}

TEST(MotionCodeTest, MostExamplesAreExact) {
  EXPECT_NEAR(*CalcMostSeconds("A16 B6 G1 A6 B0 P1 A24"), 19.44, 1e-12) << "540 TMU";
  EXPECT_NEAR(*CalcMostSeconds("A6 B0 G1 M1 X6 I0"), 5.04, 1e-12) << "140 TMU";
  EXPECT_NEAR(*CalcMostSeconds("A1 B0 G1 A1 B0 P3 F10 A1 B0 P1 A0"), 6.48, 1e-12) << "180 TMU";
  EXPECT_NEAR(*CalcMostSeconds("A1 B0 G3 A1 B0 P6 A0"), 3.96, 1e-12) << "110 TMU";
  EXPECT_FALSE(CalcMostSeconds("A1 b0"));
  EXPECT_FALSE(CalcMostSeconds("A"));
  EXPECT_FALSE(CalcMostSeconds("A-1"));
}

}  // namespace
}  // namespace hvas::shopfloor
