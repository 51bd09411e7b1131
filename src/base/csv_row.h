#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hvas {

/** Rows of a table as spreadsheets exchange it (RFC 4180). All tables of text that HVAS writes are
 made with it: names of parts come from strangers' files, and a cell that begins like a formula is
 one to a spreadsheet. */
class CsvRow {
 public:
  explicit CsvRow(char delimiter = ',') : delimiter_(delimiter) {}

  /** Adds a text, as MakeCsvCell() writes it. */
  CsvRow& Text(std::string_view text);

  /** Adds a number, in the fewest digits that give it again; an empty cell where it is not finite,
   which spreadsheets take for no number. */
  CsvRow& Number(double value);

  /** Adds a number of so many significant digits, as Number() otherwise. */
  CsvRow& Rounded(double value, int digits);

  /** Adds a number with so many digits behind the point, as Number() otherwise. */
  CsvRow& Fixed(double value, int digits);

  CsvRow& Whole(std::int64_t value);

  /** Adds empty cells. */
  CsvRow& Empty(int count = 1);

  /** Ends the row. @returns it, with the end of the line; the next one is empty. */
  [[nodiscard]] std::string End(std::string_view line_end = "\n");

 private:
  CsvRow& Add(std::string_view cell);

  char delimiter_;
  bool is_begun_{false};
  std::string text_;
};

/** Writes a text as a cell: in quotes where it has some, a delimiter of any table, a break of lines
 or blanks at its ends; with an apostrophe before it where a spreadsheet would take it for a
 formula, because it begins with = + - @ (also behind blanks, a tab or apostrophes, and in full
 width) and is no number. */
[[nodiscard]] std::string MakeCsvCell(std::string_view text);

/** Reads the content of a cell, without its quotes: without the apostrophe of MakeCsvCell(). */
[[nodiscard]] std::string_view ReadCsvCell(std::string_view content);

}  // namespace hvas
