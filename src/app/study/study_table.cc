#include "app/study/study_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/fit/csv_table.h"
#include "app/output/choice.h"

namespace hvas::app {
namespace {

/** The table with what is needed to say where something is wrong. */
class Source {
 public:
  Source(CsvTable table, std::string file) : table_(std::move(table)), file_(std::move(file)) {}

  [[nodiscard]] const CsvTable& table() const { return table_; }

  [[nodiscard]] bool Has(const std::string& column) const {
    const auto& columns = table_.columns();
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }

  [[nodiscard]] std::string Where(std::size_t row, const std::string& column) const {
    const auto& columns = table_.columns();
    const auto index = std::find(columns.begin(), columns.end(), column) - columns.begin();
    return fmt::format("{}:{}, column {} ({})", file_, table_.LineOf(row), index + 1, column);
  }

  [[nodiscard]] std::string WhereHeader() const { return file_ + ":1"; }

  /** A text that may not be missing. */
  [[nodiscard]] Result<std::string> GetText(std::size_t row, const std::string& column) const {
    const std::string_view text = table_.Get(row, column);
    if (text.empty()) {
      return Fail(ErrorCode::kInvalid, "the cell is empty", Where(row, column),
                  "fill it in, or remove the row");
    }
    return std::string(text);
  }

  /** None where the cell is empty. */
  [[nodiscard]] Result<std::optional<double>> GetNumber(std::size_t row,
                                                        const std::string& column) const {
    const std::optional<double> value = table_.GetNumber(row, column);
    if (value && !std::isfinite(*value)) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("\"{}\" is not a number", table_.Get(row, column)),
                  Where(row, column),
                  "write numbers with a decimal point and without a unit, and leave cells without "
                  "a measurement empty");
    }
    return value;
  }

 private:
  CsvTable table_;
  std::string file_;
};

Result<char> ParseDelimiter(const std::string& text) {
  if (text == "tab" || text == "\\t") {
    return '\t';
  }
  if (text.size() == 1 && std::string_view("\"\r\n ").find(text[0]) == std::string_view::npos) {
    return text[0];
  }
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" cannot delimit cells", text), "--delimiter",
              "give one character, such as \";\", or tab");
}

Result<void> CheckHeader(const Source& source) {
  const auto& columns = source.table().columns();
  if (columns.size() == 1) {
    for (const char* other : {";", "\t", "|"}) {
      if (columns[0].find(other) != std::string::npos) {
        return Fail(ErrorCode::kInvalid, "the table has one column", source.WhereHeader(),
                    fmt::format("its cells seem to have another delimiter: --delimiter '{}'",
                                other[0] == '\t' ? "tab" : other));
      }
    }
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].empty() || !names.insert(columns[i]).second) {
      return Fail(ErrorCode::kInvalid,
                  columns[i].empty() ? "a column has no name"
                                     : fmt::format("two columns have the name \"{}\"", columns[i]),
                  fmt::format("{}, column {}", source.WhereHeader(), i + 1),
                  "give each column a name of its own");
    }
  }
  return {};
}

/** Is the row of this name the sum of those above? */
Result<bool> IsSum(const std::string& name, const std::vector<std::optional<double>>& values,
                   const study::Table& above) {
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower != "sum" && lower != "total") {
    return false;
  }
  for (std::size_t j = 0; j < values.size(); ++j) {
    double sum = 0;
    for (const study::Row& row : above.rows) {
      sum += row.values[j].value_or(0);
    }
    if (!values[j] || std::abs(*values[j] - sum) > 1e-9 * std::abs(sum)) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("the row \"{}\" is not the sum of those above", name),
                  above.conditions[j], "correct it, or remove it");
    }
  }
  return true;
}

Result<StudyTable> ReadWide(const Source& source, const StudyTableOptions& options) {
  const auto& columns = source.table().columns();
  study::Table table{
      options.quantity.empty() ? "value" : options.quantity, options.unit, options.columns, {}};
  if (table.conditions.empty()) {
    table.conditions.assign(columns.begin() + 1, columns.end());
  }
  for (const std::string& condition : table.conditions) {
    if (!source.Has(condition)) {
      return Fail(
          ErrorCode::kInvalid, fmt::format("there is no column \"{}\"", condition),
          source.WhereHeader(),
          "use column names of the file; the long form has participant, condition and a value");
    }
  }
  StudyTable result;
  for (std::size_t i = 0; i < source.table().row_count(); ++i) {
    auto participant = source.GetText(i, columns[0]);
    if (!participant) {
      return Unexpected(participant.error());
    }
    study::Row row{*std::move(participant), {}};
    for (const std::string& condition : table.conditions) {
      const auto value = source.GetNumber(i, condition);
      if (!value) {
        return Unexpected(value.error());
      }
      row.values.push_back(*value);
    }
    if (i + 1 == source.table().row_count()) {
      const auto is_sum = IsSum(row.participant, row.values, table);
      if (!is_sum) {
        return Fail(ErrorCode::kInvalid, is_sum.error().message,
                    source.Where(i, is_sum.error().where), is_sum.error().remedy);
      }
      if (*is_sum) {
        result.notes.push_back(
            fmt::format("The last row, \"{}\", is the sum of the others and not a participant.",
                        row.participant));
        continue;
      }
    }
    table.rows.push_back(std::move(row));
  }
  result.content = std::move(table);
  return result;
}

Result<StudyTable> ReadLong(const Source& source, const StudyTableOptions& options) {
  const std::string value_column = options.value.empty() ? "value" : options.value;
  for (const std::string& column : {std::string("participant"), value_column}) {
    if (!source.Has(column)) {
      return Fail(
          ErrorCode::kInvalid, fmt::format("there is no column \"{}\"", column),
          source.WhereHeader(),
          "a table of trials needs participant, condition and value, or the column of --value");
    }
  }
  std::vector<study::Trial> trials;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < source.table().row_count(); ++i) {
    auto participant = source.GetText(i, "participant");
    auto condition = source.GetText(i, "condition");
    const auto value = source.GetNumber(i, value_column);
    if (!participant || !condition || !value) {
      return Unexpected(!participant ? participant.error()
                        : !condition ? condition.error()
                                     : value.error());
    }
    if (!*value) {
      ++missing;
      continue;
    }
    trials.push_back({*std::move(participant), *std::move(condition), **value});
  }
  StudyTable result;
  if (missing > 0) {
    result.notes.push_back(fmt::format("{} of {} trials have no value and are omitted.", missing,
                                       source.table().row_count()));
  }
  result.notes.push_back(
      fmt::format("{} trials: the value of a participant and condition is the {} of the trials.",
                  trials.size(), options.trials == study::TrialSummary::kMean ? "mean" : "median"));
  result.content =
      study::MakeTable(trials, options.trials,
                       options.quantity.empty() ? value_column : options.quantity, options.unit);
  return result;
}

Result<StudyTable> ReadAnswers(const Source& source) {
  std::vector<study::IdentificationAnswer> answers;
  if (!source.Has("participant")) {
    return Fail(ErrorCode::kInvalid, "there is no column \"participant\"", source.WhereHeader(),
                "a table of answers needs participant, shown and answered");
  }
  for (std::size_t i = 0; i < source.table().row_count(); ++i) {
    auto participant = source.GetText(i, "participant");
    auto shown = source.GetText(i, "shown");
    auto answered = source.GetText(i, "answered");
    if (!participant || !shown || !answered) {
      return Unexpected(!participant ? participant.error()
                        : !shown     ? shown.error()
                                     : answered.error());
    }
    answers.push_back({*std::move(participant), *std::move(shown), *std::move(answered)});
  }
  return StudyTable{std::move(answers), {}};
}

}  // namespace

CLI::Option* AddStudyTableOptions(CLI::App* command, StudyTableOptions* table) {
  CLI::Option* file =
      command->add_option("--table", table->file,
                          "Table of results (CSV); - for standard input. Wide: participant, then "
                          "one column for each condition. Long: participant, condition, value, one "
                          "row for each trial. Answers: participant, shown, answered");
  command->add_option("--delimiter", table->delimiter, "Delimiter of cells: one character, or tab")
      ->capture_default_str();
  command
      ->add_option("--columns", table->columns,
                   "Columns of a wide table to use as conditions; default: all")
      ->delimiter(',');
  command->add_option("--value", table->value, "Column of values in a long table; default: value");
  command->add_option("--quantity", table->quantity, "Name of the quantity: \"completion time\"");
  command->add_option("--unit", table->unit, "Unit of the values: s");
  const Choices<study::TrialSummary> summaries{{"mean", study::TrialSummary::kMean},
                                               {"median", study::TrialSummary::kMedian}};
  AddChoice(command, "--trials", &table->trials, summaries,
            "Summary of the trials of a participant and condition")
      ->default_str("mean");
  return file;
}

Result<StudyTable> ReadStudyTable(const StudyTableOptions& options) {
  const auto delimiter = ParseDelimiter(options.delimiter);
  if (!delimiter) {
    return Unexpected(delimiter.error());
  }
  auto table = CsvTable::Read(options.file, *delimiter);
  if (!table) {
    return Unexpected(table.error());
  }
  const Source source(*std::move(table), options.file.string());
  if (const auto checked = CheckHeader(source); !checked) {
    return Unexpected(checked.error());
  }
  if (source.Has("shown") && source.Has("answered")) {
    return ReadAnswers(source);
  }
  return source.Has("condition") ? ReadLong(source, options) : ReadWide(source, options);
}

}  // namespace hvas::app
