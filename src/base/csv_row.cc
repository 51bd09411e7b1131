#include "base/csv_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace hvas {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

std::size_t CountDigits(std::string_view text) {
  std::size_t count = 0;
  while (count < text.size() && IsDigit(text[count])) {
    ++count;
  }
  return count;
}

void SkipSign(std::string_view* text) {
  if (!text->empty() && (text->front() == '+' || text->front() == '-')) {
    text->remove_prefix(1);
  }
}

/** Whether the whole text is a number with a decimal point or comma: "-1.5", "+3e-6". */
bool IsNumber(std::string_view text) {
  SkipSign(&text);
  std::size_t digits = CountDigits(text);
  text.remove_prefix(digits);
  if (!text.empty() && (text.front() == '.' || text.front() == ',')) {
    text.remove_prefix(1);
    const std::size_t more = CountDigits(text);
    text.remove_prefix(more);
    digits += more;
  }
  if (digits > 0 && !text.empty() && (text.front() == 'e' || text.front() == 'E')) {
    text.remove_prefix(1);
    SkipSign(&text);
    digits = CountDigits(text);
    text.remove_prefix(digits);
  }
  return digits > 0 && text.empty();
}

bool BeginsFormula(std::string_view text) {
  // The last four are = + - @ in full width, which some spreadsheets take for the others.
  static constexpr std::array<std::string_view, 8> kBegins{
      "=", "+", "-", "@", "\xef\xbc\x9d", "\xef\xbc\x8b", "\xef\xbc\x8d", "\xef\xbc\xa0"};
  for (const std::string_view begin : kBegins) {
    if (text.starts_with(begin)) {
      return true;
    }
  }
  return false;
}

bool NeedsApostrophe(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  if (text.empty() || text == "-" || IsNumber(text)) {  // A dash by itself stands for no unit.
    return false;
  }
  // A cell that begins with a tab or a break is cut there by some programs.
  const bool is_control =
      text.front() != ' ' && kBlanks.find(text.front()) != std::string_view::npos;
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return is_control || BeginsFormula(text);
}

bool NeedsQuotes(std::string_view cell) {
  // Delimiters of other tables, too: a program may be set to another one.
  return cell.find_first_of("\",;|\t\r\n\v\f") != std::string_view::npos ||
         (!cell.empty() && (cell.front() == ' ' || cell.back() == ' '));
}

}  // namespace

std::string MakeCsvCell(std::string_view text) {
  std::string cell = (NeedsApostrophe(text) ? "'" : "") + std::string(text);
  if (!NeedsQuotes(cell)) {
    return cell;
  }
  std::string quoted = "\"";
  for (const char c : cell) {
    quoted.append(c == '"' ? 2 : 1, c);
  }
  return quoted + "\"";
}

std::string_view ReadCsvCell(std::string_view content) {
  return content.starts_with('\'') && NeedsApostrophe(content) ? content.substr(1) : content;
}

CsvRow& CsvRow::Add(std::string_view cell) {
  if (is_begun_) {
    text_ += delimiter_;
  }
  is_begun_ = true;
  text_ += cell;
  return *this;
}

CsvRow& CsvRow::Text(std::string_view text) {
  return Add(MakeCsvCell(text));
}

CsvRow& CsvRow::Number(double value) {
  return Add(std::isfinite(value) ? fmt::format("{}", value) : "");
}

CsvRow& CsvRow::Rounded(double value, int digits) {
  return Add(std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "");
}

CsvRow& CsvRow::Fixed(double value, int digits) {
  return Add(std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "");
}

CsvRow& CsvRow::Whole(std::int64_t value) {
  return Add(fmt::format("{}", value));
}

CsvRow& CsvRow::Empty(int count) {
  for (int i = 0; i < count; ++i) {
    Add("");
  }
  return *this;
}

std::string CsvRow::End(std::string_view line_end) {
  std::string row = std::move(text_) + std::string(line_end);
  text_.clear();
  is_begun_ = false;
  return row;
}

}  // namespace hvas
