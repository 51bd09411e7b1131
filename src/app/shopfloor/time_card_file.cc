#include "app/shopfloor/time_card_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include "app/fit/csv_table.h"
#include "orders/hand_time.h"

namespace hvas::app {
namespace {

constexpr double kLongest = 3600;  // No motion of a hand takes an hour [s]: a choice.

/** A column of times, and what one of its units is [s]. */
struct TimeColumn {
  const char* name;
  double seconds;
};

constexpr std::array kTimeColumns{TimeColumn{"seconds", 1},
                                  TimeColumn{"tmu", shopfloor::kTmuSeconds},
                                  TimeColumn{"mod", orders::kModSeconds}};

}  // namespace

Result<shopfloor::TimeCard> ReadTimeCard(const std::filesystem::path& file) {
  const auto table = CsvTable::Read(file, CsvTable::kAnyDelimiter);
  if (!table) {
    return Unexpected(table.error());
  }
  if (const auto has_codes = table->Require({"code"}); !has_codes) {
    return Unexpected(has_codes.error());
  }
  const auto column =
      std::find_if(kTimeColumns.begin(), kTimeColumns.end(), [&table](const TimeColumn& one) {
        return std::find(table->columns().begin(), table->columns().end(), one.name) !=
               table->columns().end();
      });
  constexpr const char* kRemedy = "write a table with the columns code and seconds, tmu or mod";
  if (column == kTimeColumns.end()) {
    return Fail(ErrorCode::kInvalid, "the table has no column of times", file.string(), kRemedy);
  }
  shopfloor::TimeCard card{file.filename().string(), {}};
  for (std::size_t row = 0; row < table->row_count(); ++row) {
    const std::string code(table->Get(row, "code"));
    const auto time = table->GetNumber(row, column->name);
    const auto fail = [&](const std::string& what) {
      return Fail(ErrorCode::kInvalid, fmt::format("line {}: {}", table->LineOf(row), what),
                  file.string(), kRemedy);
    };
    if (code.empty() || std::isalpha(static_cast<unsigned char>(code.front())) == 0) {
      return fail(fmt::format("\"{}\" is no code, which begins with a letter", code));
    }
    if (!time || !(*time >= 0 && column->seconds * *time <= kLongest)) {
      return fail(fmt::format("\"{}\" is no time from 0 to {:.0f} s", table->Get(row, column->name),
                              kLongest));
    }
    if (!card.seconds.emplace(code, column->seconds * *time).second) {
      return fail(fmt::format("the code {} comes twice", code));
    }
  }
  return card;
}

}  // namespace hvas::app
