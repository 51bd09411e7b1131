#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace hvas::app {

/** The number that a text is, with a decimal point or comma; nothing else before or behind it. */
[[nodiscard]] std::optional<double> ParseNumber(std::string_view text);

/** A table of text with named columns, as spreadsheets exchange it (RFC 4180). */
class CsvTable {
 public:
  /** A delimiter to find out: ';' where the first line has that and no ',', or else ','. */
  static constexpr char kAnyDelimiter = '\0';

  /** Reads a file; "-" is the standard input. Rows that end early are filled up with nothing.
   Errors: kNotFound (no such file), kInvalid (no header, quotes that do not close, a row with more
   cells than there are columns), with the line. */
  [[nodiscard]] static Result<CsvTable> Read(const std::filesystem::path& file,
                                             char delimiter = ',');

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  [[nodiscard]] std::size_t row_count() const { return rows_.size(); }

  /** The line of the file in which a row begins, from 1. */
  [[nodiscard]] std::size_t LineOf(std::size_t row) const { return lines_[row]; }

  /** Errors: kInvalid, naming the columns that a table has to have and has not. */
  [[nodiscard]] Result<void> Require(const std::vector<std::string>& columns) const;

  /** The cell, without blanks around it; nothing where the column or the text is missing. */
  [[nodiscard]] std::string_view Get(std::size_t row, std::string_view column) const;

  /** A number. None where the cell is empty; NaN where it is no number. */
  [[nodiscard]] std::optional<double> GetNumber(std::size_t row, std::string_view column) const;

  /** Adds a row of empty cells. @returns its number. */
  std::size_t AddRow();

  /** Sets a cell, adding the column if it is new. */
  void Set(std::size_t row, std::string_view column, std::string value);

  /** Writes quotes where they are needed, and the delimiter that was read. */
  [[nodiscard]] std::string ToText() const;

 private:
  [[nodiscard]] std::size_t Find(std::string_view column) const;

  char delimiter_{','};
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_;
};

}  // namespace hvas::app
