#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hvas::app {

/** A table for a terminal: columns that begin at the left, the last of them with names, and columns
 of figures. Each is as wide as what stands in it. Where the terminal is too narrow, names lose
 their beginning; where that is not enough, the rest of the figures follows below, beside the names
 again. */
class TextTable {
 public:
  /** @param heads  Of the columns; a head of two lines has a newline in it.
   @param left  How many columns begin at the left. */
  explicit TextTable(std::vector<std::string> heads, std::size_t left = 1)
      : heads_(std::move(heads)), left_(left) {}

  /** Adds a row. A row with fewer cells than heads ends with them.
   @param below  Words that follow below it, indented; may be empty. */
  void Add(std::vector<std::string> cells, std::string below = {});

  /** @param indent  Of every line. */
  [[nodiscard]] std::string ToText(std::size_t indent = 0) const;

 private:
  struct Row {
    std::vector<std::string> cells;
    std::string below;
  };

  [[nodiscard]] std::vector<std::size_t> CalcWidths() const;
  /** Takes from the width of the names what the table is wider than the terminal. */
  void NarrowNames(std::size_t room, std::vector<std::size_t>* widths) const;
  /** Splits the heads into lines with a cell for each column. */
  [[nodiscard]] std::vector<std::vector<std::string>> SplitHeads() const;

  std::vector<std::string> heads_;
  std::size_t left_;
  std::vector<Row> rows_;
};

}  // namespace hvas::app
