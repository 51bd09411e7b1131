#include "base/csv_row.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hvas {
namespace {

TEST(CsvCell, ThatBeginsLikeAFormulaIsATextToASpreadsheet) {
  EXPECT_EQ(MakeCsvCell("=1+1"), "'=1+1");
  EXPECT_EQ(MakeCsvCell("+cmd|' /C calc'!A0"), "\"'+cmd|' /C calc'!A0\"");
  EXPECT_EQ(MakeCsvCell("-2+3"), "'-2+3");
  EXPECT_EQ(MakeCsvCell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(MakeCsvCell("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(MakeCsvCell("\rx"), "\"'\rx\"");
  EXPECT_EQ(MakeCsvCell(" =1"), "' =1");
  EXPECT_EQ(MakeCsvCell("'=1"), "''=1");
  EXPECT_EQ(MakeCsvCell("\xef\xbc\x9d"
                        "1"),
            "'\xef\xbc\x9d"
            "1");
  EXPECT_EQ(MakeCsvCell("--1"), "'--1");
  EXPECT_EQ(MakeCsvCell("-1e5+A1"), "'-1e5+A1");
}

TEST(CsvCell, ThatIsANumberOrAPlainTextStays) {
  for (const char* text : {"", "-1.5", "+3", "-.5e-3", "1,5e", "bolt M8x20", "a=b", "x - y",
                           "'quoted'", "H7/p6", "'"}) {
    EXPECT_EQ(ReadCsvCell(text), text);
  }
  EXPECT_EQ(MakeCsvCell("-1.5"), "-1.5");
  EXPECT_EQ(MakeCsvCell("-1,5"), "\"-1,5\"");
  EXPECT_EQ(MakeCsvCell("+3e-6"), "+3e-6");
  EXPECT_EQ(MakeCsvCell("-"), "-");
  EXPECT_EQ(MakeCsvCell("bolt M8x20"), "bolt M8x20");
  EXPECT_EQ(MakeCsvCell("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(MakeCsvCell("a;b"), "\"a;b\"");
}

/** The content of a cell that stands alone in a row. */
std::string Unquote(const std::string& cell) {
  if (!cell.starts_with('"')) {
    return cell;
  }
  std::string content;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    content += cell[i];
    i += cell[i] == '"' ? 1 : 0;
  }
  return content;
}

TEST(CsvCell, IsReadBackAsItWas) {
  const std::string letters = "=+-@'\"\t\r\n ,;1.ex";
  for (std::size_t number = 0; number < 17 * 17 * 17 * 17; ++number) {
    std::string text;
    for (std::size_t rest = number; rest > 0; rest /= 17) {
      text += letters[rest % 17 % letters.size()];
    }
    const std::string content = Unquote(MakeCsvCell(text));
    ASSERT_EQ(ReadCsvCell(content), text) << MakeCsvCell(text);
  }
}

TEST(CsvRow, HasNumbersAsNumbersAndOneEndForEachRow) {
  CsvRow row;
  row.Text("part").Number(-1.5).Rounded(-1.0 / 3, 3).Fixed(-2, 2).Whole(-7).Empty(2);
  EXPECT_EQ(row.End(), "part,-1.5,-0.333,-2.00,-7,,\n");
  row.Number(std::numeric_limits<double>::quiet_NaN())
      .Fixed(std::numeric_limits<double>::infinity(), 2)
      .Text("=x");
  EXPECT_EQ(row.End("\r\n"), ",,'=x\r\n");
  EXPECT_EQ(CsvRow(';').Text("a").Text("b").End(), "a;b\n");
}

}  // namespace
}  // namespace hvas
