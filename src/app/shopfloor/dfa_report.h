#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "shopfloor/dfa_rating.h"

namespace hvas::app {

/** A worksheet with what it was made of. */
struct DfaReport {
  std::string title;  ///< The product, or the file of the worksheet.
  const shopfloor::DfaSheet* sheet{nullptr};
  const simulation::Model* model{nullptr};      ///< Null for a worksheet of the user's own.
  const shopfloor::DfaRating* rating{nullptr};  ///< Null for a worksheet of the user's own.
  int modapts_mods{0};  ///< Time of the plan's hands beside it [MOD]; 0: none.
};

/** Reads a worksheet: a table with the columns part, count, handling_code, insertion_code and
 min_parts. Errors: those of CsvTable and of MakeDfaSheet; kInvalid with the line for a number that
 is none. */
[[nodiscard]] Result<shopfloor::DfaSheet> ReadDfaSheet(const std::filesystem::path& file);

/** The worksheet as such a table, with its times. */
[[nodiscard]] std::string MakeDfaTable(const DfaReport& report);

/** The worksheet, its sums and the advice as JSON. Every number's name ends in its unit. */
[[nodiscard]] nlohmann::ordered_json MakeDfaJson(const DfaReport& report);

void PrintDfa(const DfaReport& report);

/** A page with the worksheet, each row with what its codes were chosen by. */
[[nodiscard]] std::string MakeDfaPage(const DfaReport& report);

}  // namespace hvas::app
