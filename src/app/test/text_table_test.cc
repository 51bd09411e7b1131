#include "app/output/text_table.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include "app/output/text_layout.h"
#include "base/random.h"

namespace hvas::app {
namespace {

/** A terminal of so many columns, for as long as this lives. */
class WithColumns {
 public:
  explicit WithColumns(std::size_t columns) {
    ::setenv("COLUMNS", std::to_string(columns).c_str(), 1);
  }

  ~WithColumns() { ::unsetenv("COLUMNS"); }

  WithColumns(const WithColumns&) = delete;
  WithColumns& operator=(const WithColumns&) = delete;
};

std::vector<std::string> SplitIntoLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(TextTable, IsAsWideAsWhatStandsInIt) {
  TextTable table({"name", "force\nN", "n"});
  table.Add({"a", "1.5", "10"});
  table.Add({"longer", "22.25", "7"}, "a note");
  EXPECT_EQ(table.ToText(),
            "name   force  n\n"
            "           N\n"
            "a        1.5 10\n"
            "longer 22.25  7\n"
            "    a note\n");
}

TEST(TextTable, CutsNamesBeforeItBreaksColumns) {
  const WithColumns columns(50);
  TextTable table({"name", "value"});
  std::string name(60, 'x');
  name += "end";
  table.Add({name, "1234567"});
  const auto lines = SplitIntoLines(table.ToText());
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(CalcWidth(lines[1]), 50U);
  EXPECT_EQ(lines[1].substr(0, 2), "..");
  EXPECT_NE(lines[1].find("end 1234567"), std::string::npos);
}

TEST(TextTable, KeepsEveryFigureOfEveryWidthAndNeverGoesBeyondIt) {
  Random random(20260707);
  for (int draw = 0; draw < 200; ++draw) {
    const auto room = static_cast<std::size_t>(random.Uniform(40, 140));
    const WithColumns columns(room);
    const auto left = static_cast<std::size_t>(random.Uniform(0, 3));
    const auto count = left + static_cast<std::size_t>(random.Uniform(1, 14));
    const auto word = [&random](double most) {
      return std::string(static_cast<std::size_t>(random.Uniform(1, most)), 'w');
    };
    std::vector<std::string> heads;
    for (std::size_t i = 0; i < count; ++i) {
      heads.push_back(word(i + 1 == left ? 60 : 8));
    }
    TextTable table(heads, left);
    std::vector<std::string> figures;
    for (int row = 0; row < 5; ++row) {
      std::vector<std::string> cells;
      for (std::size_t i = 0; i < count; ++i) {
        if (i < left) {
          cells.push_back(word(i + 1 == left ? 60 : 4));
        } else {
          cells.push_back(std::to_string(1000 * row + static_cast<int>(i) + 100000));
          figures.push_back(cells.back());
        }
      }
      table.Add(cells);
    }
    const std::string text = table.ToText();
    for (const std::string& figure : figures) {
      EXPECT_NE(text.find(figure), std::string::npos) << figure << "\n" << text;
    }
    for (const std::string& line : SplitIntoLines(text)) {
      EXPECT_LE(CalcWidth(line), room) << text;
    }
  }
}

TEST(Fold, BreaksLongLinesAndKeepsAllWords) {
  const WithColumns columns(40);
  const std::string text = "  one two three four five six seven eight nine ten\nshort\n";
  const std::string folded = Fold(text);
  std::string words = folded;
  std::replace(words.begin(), words.end(), '\n', ' ');
  std::istringstream a(text);
  std::istringstream b(words);
  for (std::string x, y; a >> x;) {
    ASSERT_TRUE(b >> y);
    EXPECT_EQ(x, y);
  }
  EXPECT_EQ(folded, "  one two three four five six seven\n    eight nine ten\nshort\n");
}

}  // namespace
}  // namespace hvas::app
