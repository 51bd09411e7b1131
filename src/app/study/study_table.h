#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "base/result.h"
#include "study/analysis.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hvas::app {

/** How a table of results is to be read. */
struct StudyTableOptions {
  std::filesystem::path file;        ///< "-" is the standard input.
  std::string delimiter{","};        ///< One character, or "tab".
  std::vector<std::string> columns;  ///< Conditions of a wide table; empty: all other columns.
  std::string value;                 ///< Column of values of a long table; empty: "value".
  std::string quantity;              ///< What the values are; by the table without.
  std::string unit;
  study::TrialSummary trials{study::TrialSummary::kMean};
};

/** A table of values, or of answers of a blind identification. */
struct StudyTable {
  std::variant<study::Table, std::vector<study::IdentificationAnswer>> content;
  std::vector<std::string> notes;  ///< What was passed over.
};

/** @returns --table itself, which a command may require. */
CLI::Option* AddStudyTableOptions(CLI::App* command, StudyTableOptions* table);

/** Reads one of three forms, told by the header: wide (first column the participant, the others
 conditions), long (participant, condition, a value, one row a trial), answers (participant, shown,
 answered). A last row "sum" or "total" of a wide table is passed over where it is the sum.
 Errors: kNotFound, kInvalid, with file, line and column. */
[[nodiscard]] Result<StudyTable> ReadStudyTable(const StudyTableOptions& options);

}  // namespace hvas::app
