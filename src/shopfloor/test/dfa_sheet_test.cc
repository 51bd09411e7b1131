#include "shopfloor/dfa_sheet.h"

#include <gtest/gtest.h>

namespace hvas::shopfloor {
namespace {

// A dry iron before and after a change (Open Mechanical Engineering Journal 10, 2016, 173, tables 3
// and 4), with the two sums of rows that are wrong in print mended.
std::vector<DfaRow> DryIronBefore() {
  return {{"Casing", 1, "30", "17", 1},
          {"Knob ring", 1, "23", "31", 0},
          {"Knob", 1, "10", "01", 1},
          {"Signal lamp cover", 1, "70", "02", 1},
          {"Handle", 1, "30", "06", 0},
          {"Vertical cord lift", 1, "20", "01", 0},
          {"Back cover", 1, "30", "00", 0},
          {"Thermostat", 1, "83", "16", 1},
          {"Sole plate", 1, "00", "00", 1},
          {"Sole plate cover", 1, "30", "13", 1},
          {"Sole back plate", 1, "30", "48", 0},
          {"Screw A", 5, "11", "39", 0},
          {"Screw B", 8, "11", "39", 0}};
}

std::vector<DfaRow> DryIronAfter() {
  std::vector<DfaRow> rows = DryIronBefore();
  rows.back().count = 7;
  for (const char* gone : {"Knob ring", "Back cover", "Sole back plate"}) {
    std::erase_if(rows, [gone](const DfaRow& row) { return row.part == gone; });
  }
  return rows;
}

TEST(DfaSheetTest, DryIronIsExact) {
  const auto before = MakeDfaSheet(DryIronBefore());
  ASSERT_TRUE(before);
  EXPECT_NEAR(before->seconds, 207.14, 1e-9);
  EXPECT_EQ(before->parts, 24);
  EXPECT_EQ(before->min_parts, 6);
  EXPECT_NEAR(100 * before->CalcIndex(kIdealSecondsRounded), 8.69, 0.005);
  EXPECT_NEAR(before->CalcIndex(kIdealSeconds), 6 * 2.93 / 207.14, 1e-12);
  const auto after = MakeDfaSheet(DryIronAfter());
  ASSERT_TRUE(after);
  EXPECT_NEAR(after->seconds, 176.08, 1e-9);
  EXPECT_EQ(after->parts, 20);
  EXPECT_NEAR(100 * after->CalcIndex(kIdealSecondsRounded), 10.22, 0.005);
}

TEST(DfaSheetTest, ACodeWithoutAPublicTimeTakesThatOfAHarderOne) {
  const auto known = FindHandlingTime("30");
  ASSERT_TRUE(known);
  EXPECT_EQ(known->code, "30");
  const auto small = FindHandlingTime("02");
  ASSERT_TRUE(small);
  EXPECT_EQ(small->code, "05");
  EXPECT_GT(small->seconds, FindHandlingTime("01")->seconds);
  const auto held = FindInsertionTime("07");
  ASSERT_TRUE(held);
  EXPECT_EQ(held->code, "08");
  EXPECT_EQ(FindInsertionTime("40")->code, "48");
}

TEST(DfaSheetTest, EveryCodeThatGeometryGivesHasATime) {
  for (char first = '0'; first <= '3'; ++first) {
    for (char second = '0'; second <= '9'; ++second) {
      EXPECT_TRUE(FindHandlingTime(std::string{first, second})) << first << second;
    }
  }
  for (const char* code :
       {"00", "02", "06", "08", "10", "12", "16", "18", "31", "38", "39", "41", "48", "49"}) {
    EXPECT_TRUE(FindInsertionTime(code)) << code;
    EXPECT_FALSE(DescribeInsertion(code).empty());
  }
}

TEST(DfaSheetTest, TellsTheRowThatIsWrong) {
  for (const DfaRow& bad : {DfaRow{"Lid", 1, "3", "00", 1}, DfaRow{"Lid", 1, "30", "ab", 1},
                            DfaRow{"Lid", 0, "30", "00", 0}, DfaRow{"Lid", 1, "30", "00", 2},
                            DfaRow{"Lid", 1, "30", "90", 1}}) {
    const auto sheet = MakeDfaSheet({bad});
    ASSERT_FALSE(sheet);
    EXPECT_EQ(sheet.error().where, "Lid");
  }
  EXPECT_EQ(MakeDfaSheet({})->CalcIndex(3), 0);
}

}  // namespace
}  // namespace hvas::shopfloor
