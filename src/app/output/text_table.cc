#include "app/output/text_table.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"

namespace hvas::app {
namespace {

constexpr std::size_t kGap = 1;         // Columns between columns.
constexpr std::size_t kLeastName = 18;  // Narrower than that a name says too little.

std::vector<std::string> SplitLines(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

std::string Cell(const std::string& text, std::size_t width, bool is_left) {
  if (is_left) {
    return PadTo(text, width);
  }
  const std::size_t used = CalcWidth(text);
  return std::string(width - std::min(width, used), ' ') + text;
}

void EndLine(std::string* text) {
  while (text->ends_with(' ')) {
    text->pop_back();
  }
  *text += '\n';
}

/** Columns from `begin` to `end`, which fit beside the names. */
struct Block {
  std::size_t begin;
  std::size_t end;
};

/** @param left  How many columns stand in every block. */
std::vector<Block> MakeBlocks(const std::vector<std::size_t>& widths, std::size_t left,
                              std::size_t room) {
  std::size_t names = 0;
  for (std::size_t i = 0; i < left; ++i) {
    names += widths[i] + kGap;
  }
  std::vector<Block> blocks;
  std::size_t begin = left;
  do {
    std::size_t end = begin;
    std::size_t used = names;
    while (end < widths.size() && (end == begin || used + widths[end] <= room)) {
      used += widths[end++] + kGap;
    }
    blocks.push_back({begin, end});
    begin = end;
  } while (begin < widths.size());
  return blocks;
}

}  // namespace

void TextTable::Add(std::vector<std::string> cells, std::string below) {
  rows_.push_back({std::move(cells), std::move(below)});
}

std::vector<std::size_t> TextTable::CalcWidths() const {
  std::vector<std::size_t> widths;
  for (const std::string& head : heads_) {
    std::size_t width = 0;
    for (const std::string& line : SplitLines(head)) {
      width = std::max(width, CalcWidth(line));
    }
    widths.push_back(width);
  }
  for (const Row& row : rows_) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      widths[i] = std::max(widths[i], CalcWidth(row.cells[i]));
    }
  }
  return widths;
}

void TextTable::NarrowNames(std::size_t room, std::vector<std::size_t>* widths) const {
  const std::size_t whole =
      std::accumulate(widths->begin(), widths->end(), std::size_t{0}) + kGap * (widths->size() - 1);
  if (left_ > 0 && whole > room) {
    std::size_t& name = (*widths)[left_ - 1];
    const std::size_t least = std::min(name, kLeastName);
    const std::size_t too_wide = whole - room;
    name = name >= least + too_wide ? name - too_wide : std::min(name, room / 3);
  }
}

std::vector<std::vector<std::string>> TextTable::SplitHeads() const {
  std::vector<std::vector<std::string>> lines;
  for (std::size_t i = 0; i < heads_.size(); ++i) {
    const std::vector<std::string> of_head = SplitLines(heads_[i]);
    lines.resize(std::max(lines.size(), of_head.size()), std::vector<std::string>(heads_.size()));
    for (std::size_t k = 0; k < of_head.size(); ++k) {
      lines[k][i] = of_head[k];
    }
  }
  return lines;
}

std::string TextTable::ToText(std::size_t indent) const {
  std::vector<std::size_t> widths = CalcWidths();
  const std::size_t room = CountColumns() - indent;
  NarrowNames(room, &widths);
  const std::vector<std::vector<std::string>> heads = SplitHeads();
  std::string text;
  for (const Block& block : MakeBlocks(widths, left_, room)) {
    std::vector<std::size_t> columns(left_ + block.end - block.begin);
    std::iota(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(left_), 0);
    std::iota(columns.begin() + static_cast<std::ptrdiff_t>(left_), columns.end(), block.begin);
    const auto add_line = [&](const std::vector<std::string>& cells) {
      std::string line(indent, ' ');
      for (const std::size_t i : columns) {
        line +=
            Cell(i < cells.size() ? cells[i] : "", widths[i], i < left_) + std::string(kGap, ' ');
      }
      EndLine(&line);
      text += line;
    };
    text += text.empty() ? "" : "\n";
    for (const std::vector<std::string>& line : heads) {
      const bool is_empty = std::all_of(columns.begin(), columns.end(),
                                        [&](std::size_t i) { return line[i].empty(); });
      if (!is_empty) {
        add_line(line);
      }
    }
    for (const Row& row : rows_) {
      add_line(row.cells);
      if (!row.below.empty() && block.begin == left_) {
        text += Wrap(row.below, indent + 4);
      }
    }
  }
  return text;
}

}  // namespace hvas::app
