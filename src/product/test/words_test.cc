#include "product/words.h"

#include <gtest/gtest.h>

namespace hvas::product {
namespace {

TEST(Words, FoldedNamesAreInSmallAsciiLettersWithTheirWordsApart) {
  EXPECT_EQ(FoldName("HexNut"), "hex nut");
  EXPECT_EQ(FoldName("L\u00fcfter Geh\u00c4use"), "luefter gehaeuse");
  EXPECT_EQ(FoldName("\u00c9crou M3\u00d710"), "ecrou m3x10");
  EXPECT_EQ(FoldName("PCB_Main"), "pcb_main");
  EXPECT_EQ(FoldName("\xff\xc3"), "\xff\xc3");  // No UTF-8: kept as it is.
  EXPECT_EQ(FoldName(""), "");
}

TEST(Words, AWordStandsForItself) {
  for (const char* text : {"pla", "pla+", "3d pla", "pla_2", "plas", "pla3"}) {
    EXPECT_TRUE(HasWord(text, "pla")) << text;
  }
  for (const char* text : {"plate", "plasma", "epla", "steel plate", "", "pl a"}) {
    EXPECT_FALSE(HasWord(text, "pla")) << text;
  }
  for (const char* text : {"din 912", "din912", "din_912-m3", "iso x; din-912"}) {
    EXPECT_TRUE(HasWord(text, "din 912")) << text;
  }
  for (const char* text : {"din 9120", "odin 912", "din 91", "din"}) {
    EXPECT_FALSE(HasWord(text, "din 912")) << text;
  }
  EXPECT_FALSE(HasWord("nut", ""));
}

TEST(Words, RunsOfLettersAndDigitsAreSplit) {
  const std::vector<Word> words = SplitWords("lm8uu-2");
  ASSERT_EQ(words.size(), 4U);
  EXPECT_EQ(words[0].text, "lm");
  EXPECT_EQ(words[2].text, "uu");
  EXPECT_EQ(words[3].begin, 6U);
  EXPECT_EQ(words[3].end, 7U);
}

}  // namespace
}  // namespace hvas::product
