#include "app/fit/csv_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <limits>

#include <csv.h>
#include <fmt/format.h>

#include "base/csv_row.h"
#include "base/regular_file.h"

namespace hvas::app {
namespace {

/** What the parser hands over, cell by cell. */
struct Parsed {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;  // In which they begin.
  std::vector<std::string> row;
  std::size_t line{1};  // In which the row begins that is being read.
};

void TakeCell(void* text, std::size_t size, void* data) {
  static_cast<Parsed*>(data)->row.emplace_back(
      ReadCsvCell(std::string_view(static_cast<const char*>(text), size)));
}

void TakeRow(int /*last_character*/, void* data) {
  auto* parsed = static_cast<Parsed*>(data);
  parsed->rows.push_back(std::move(parsed->row));
  parsed->lines.push_back(parsed->line);
  parsed->row.clear();
}

/** Keeps Parsed::line: the parser, which is given a line or a piece of one at a time, does not
 * tell.
 */
class LineCounter {
 public:
  explicit LineCounter(Parsed* parsed) : parsed_(parsed) {}

  /** After the parser has had the piece, which ends at the end of its line, or before. */
  void Pass(std::string_view piece) {
    has_row_ = has_row_ || parsed_->rows.size() > rows_;
    has_text_ = has_text_ || piece.find_first_not_of(" \t\r\n") != std::string_view::npos;
    rows_ = parsed_->rows.size();
    if (piece.back() != '\n') {
      return;
    }
    ++line_;
    is_open_ = !has_row_ && (has_text_ || is_open_);
    parsed_->line = is_open_ ? parsed_->line : line_;
    has_row_ = false;
    has_text_ = false;
  }

 private:
  Parsed* parsed_;
  std::size_t line_{1};
  std::size_t rows_{0};
  bool has_row_{false};
  bool has_text_{false};
  bool is_open_{false};  // A row goes on in the next line, by quotes.
};

/** Guesses the delimiter from the first line. */
char GuessDelimiter(std::string_view text) {
  const std::string_view first = text.substr(0, text.find('\n'));
  const bool has_semicolon = first.find(';') != std::string_view::npos;
  return has_semicolon && first.find(',') == std::string_view::npos ? ';' : ',';
}

/** All of the standard input, which has no size. */
std::string ReadInput() {
  std::string text;
  std::array<char, 1 << 16> buffer;
  for (std::size_t size = 0; (size = std::fread(buffer.data(), 1, buffer.size(), stdin)) > 0;) {
    text.append(buffer.data(), size);
  }
  return text;
}

/** Parses a table whose delimiter is guessed where it is kAnyDelimiter. */
Result<Parsed> ParseText(std::string_view text, const std::string& name, char* delimiter) {
  csv_parser parser{};
  csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL);
  Parsed parsed;
  bool is_good = true;
  LineCounter lines(&parsed);
  *delimiter = *delimiter == CsvTable::kAnyDelimiter ? GuessDelimiter(text) : *delimiter;
  csv_set_delim(&parser, static_cast<unsigned char>(*delimiter));
  while (is_good && !text.empty()) {
    const std::string_view piece = text.substr(0, std::min(text.find('\n'), text.size() - 1) + 1);
    is_good =
        csv_parse(&parser, piece.data(), piece.size(), TakeCell, TakeRow, &parsed) == piece.size();
    lines.Pass(piece);
    text.remove_prefix(piece.size());
  }
  is_good = is_good && csv_fini(&parser, TakeCell, TakeRow, &parsed) == 0;
  const int error = csv_error(&parser);
  csv_free(&parser);
  if (!is_good) {
    return Fail(ErrorCode::kInvalid, csv_strerror(error), fmt::format("{}:{}", name, parsed.line),
                "write a quote inside a cell twice, and close each quoted cell");
  }
  return parsed;
}

}  // namespace

std::optional<double> ParseNumber(std::string_view text) {
  std::string number(text);
  const std::size_t comma = number.find(',');
  if (comma != std::string::npos) {
    number[comma] = '.';
  }
  const bool has_plus = number.size() > 1 && number[0] == '+' && number[1] != '-';
  const char* const begin = number.data() + (has_plus ? 1 : 0);
  const char* const stop = number.data() + number.size();
  double value = 0;
  const auto [end, error] = std::from_chars(begin, stop, value);
  return error == std::errc() && end == stop ? std::optional(value) : std::nullopt;
}

Result<CsvTable> CsvTable::Read(const std::filesystem::path& path, char delimiter) {
  const auto text = path == "-" ? Result<std::string>(ReadInput()) : ReadRegularFile(path);
  if (!text) {
    return Unexpected(text.error());
  }
  auto parsed = ParseText(*text, path.string(), &delimiter);
  if (!parsed) {
    return Unexpected(parsed.error());
  }
  if (parsed->rows.empty()) {
    return Fail(ErrorCode::kInvalid, "is empty", path.string(),
                "add a first line with the names of the columns");
  }
  CsvTable table;
  table.delimiter_ = delimiter;
  table.columns_ = std::move(parsed->rows.front());
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (table.columns_.front().starts_with(kByteOrderMark)) {
    table.columns_.front().erase(0, kByteOrderMark.size());
  }
  for (std::size_t i = 1; i < parsed->rows.size(); ++i) {
    if (parsed->rows[i].size() > table.columns_.size()) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("has {} cells, but there are {} columns", parsed->rows[i].size(),
                              table.columns_.size()),
                  fmt::format("{}:{}", path.string(), parsed->lines[i]),
                  fmt::format("put cells with '{}' in quotes", delimiter));
    }
    parsed->rows[i].resize(table.columns_.size());
    table.rows_.push_back(std::move(parsed->rows[i]));
    table.lines_.push_back(parsed->lines[i]);
  }
  return table;
}

std::size_t CsvTable::Find(std::string_view column) const {
  return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) -
                                  columns_.begin());
}

Result<void> CsvTable::Require(const std::vector<std::string>& columns) const {
  std::string missing;
  for (const std::string& column : columns) {
    if (Find(column) == columns_.size()) {
      missing += (missing.empty() ? "" : ", ") + column;
    }
  }
  if (missing.empty()) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, "lacks the columns " + missing, "the first line",
              "use the column names of hvas fit --help");
}

std::string_view CsvTable::Get(std::size_t row, std::string_view column) const {
  const std::size_t index = Find(column);
  std::string_view cell = index < columns_.size() ? std::string_view(rows_[row][index]) : "";
  while (!cell.empty() && cell.front() == ' ') {
    cell.remove_prefix(1);
  }
  while (!cell.empty() && cell.back() == ' ') {
    cell.remove_suffix(1);
  }
  return cell;
}

std::optional<double> CsvTable::GetNumber(std::size_t row, std::string_view column) const {
  const std::string_view cell = Get(row, column);
  if (cell.empty()) {
    return std::nullopt;
  }
  double value = 0;
  const char* begin = cell.data() + (cell.front() == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), value);
  const bool is_number = error == std::errc() && end == cell.data() + cell.size();
  return is_number ? value : std::numeric_limits<double>::quiet_NaN();
}

std::size_t CsvTable::AddRow() {
  rows_.emplace_back(columns_.size());
  lines_.push_back(rows_.size() + 1);  // The first line has the columns.
  return rows_.size() - 1;
}

void CsvTable::Set(std::size_t row, std::string_view column, std::string value) {
  const std::size_t index = Find(column);
  if (index == columns_.size()) {
    columns_.emplace_back(column);
    for (std::vector<std::string>& cells : rows_) {
      cells.emplace_back();
    }
  }
  rows_[row][index] = std::move(value);
}

std::string CsvTable::ToText() const {
  std::string text;
  CsvRow row(delimiter_);
  const auto add = [&](const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) {
      row.Text(cell);
    }
    text += row.End();
  };
  add(columns_);
  for (const std::vector<std::string>& cells : rows_) {
    add(cells);
  }
  return text;
}

}  // namespace hvas::app
