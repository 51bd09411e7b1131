#include "shopfloor/dfa_sheet.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace hvas::shopfloor {
namespace {

/** A code with its time [s]. */
struct Timed {
  std::string_view code;
  double seconds;
};

// Times that stand in public worksheets (Open Mechanical Engineering Journal 10, 2016, 173, tables
// 3 and 4; lecture slides and student sheets) or in Whitney, Fig. 15-1; ascending by code.
constexpr std::array kHandling{
    Timed{"00", 1.13}, Timed{"01", 1.43}, Timed{"03", 1.69}, Timed{"04", 2.18}, Timed{"05", 1.84},
    Timed{"06", 2.17}, Timed{"08", 2.45}, Timed{"09", 2.98}, Timed{"10", 1.5},  Timed{"11", 1.8},
    Timed{"12", 2.25}, Timed{"13", 2.06}, Timed{"15", 2.25}, Timed{"16", 2.57}, Timed{"18", 3},
    Timed{"20", 1.8},  Timed{"21", 2.1},  Timed{"22", 2.55}, Timed{"23", 2.36}, Timed{"25", 2.57},
    Timed{"26", 2.9},  Timed{"27", 3.38}, Timed{"28", 3.18}, Timed{"30", 1.95}, Timed{"31", 2.25},
    Timed{"32", 2.7},  Timed{"33", 2.51}, Timed{"35", 2.73}, Timed{"36", 3.06}, Timed{"37", 3.55},
    Timed{"38", 3.34}, Timed{"70", 5.1},  Timed{"83", 5.6}};

constexpr std::array kInsertion{
    Timed{"00", 1.5}, Timed{"01", 2.5}, Timed{"02", 2.5}, Timed{"03", 3.5}, Timed{"06", 5.5},
    Timed{"08", 6.5}, Timed{"10", 4},   Timed{"13", 6},   Timed{"16", 8},   Timed{"17", 9},
    Timed{"31", 5},   Timed{"38", 6},   Timed{"39", 8},   Timed{"48", 8.5}, Timed{"51", 9}};

bool IsCode(std::string_view code) {
  return code.size() == 2 && std::isdigit(static_cast<unsigned char>(code[0])) != 0 &&
         std::isdigit(static_cast<unsigned char>(code[1])) != 0;
}

/** What stands in different parts of a chart does not compare: handling with one hand (0 to 3),
 with an aid (4 to 7), with two hands (8, 9). */
int HandlingClassOf(char digit) {
  return digit < '4' ? 0 : digit < '8' ? 1 : 2;
}

/** Added (0 to 2), secured at once (3 to 5), a separate operation. */
int InsertionClassOf(char digit) {
  return digit < '3' ? 0 : digit < '6' ? 1 : 2;
}

// How difficult the second digit of a code says a part to be, by digit: a thin part of more than
// 6 mm is easier to grasp than a thick one of less.
using Ranks = std::array<int, 10>;
constexpr Ranks kHandlingRanks{0, 1, 3, 2, 4, 5, 6, 8, 7, 9};
constexpr Ranks kInsertionRanks{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

template <typename Class>
std::optional<CodeTime> FindTime(std::span<const Timed> table, const Ranks& ranks,
                                 const Class& class_of, std::string_view code) {
  if (!IsCode(code)) {
    return std::nullopt;
  }
  const auto rank_of = [&ranks](std::string_view of) {
    return ranks[static_cast<std::size_t>(of[1] - '0')];
  };
  const Timed* harder = nullptr;   // Harder in both digits, the one of the least time.
  const Timed* hardest = nullptr;  // The one of the most time of those of its class.
  for (const Timed& entry : table) {
    if (entry.code == code) {
      return CodeTime{entry.seconds, std::string(code)};
    }
    if (class_of(entry.code[0]) != class_of(code[0])) {
      continue;
    }
    const bool is_harder = entry.code[0] >= code[0] && rank_of(entry.code) >= rank_of(code);
    harder = is_harder && (harder == nullptr || entry.seconds < harder->seconds) ? &entry : harder;
    hardest = hardest == nullptr || entry.seconds > hardest->seconds ? &entry : hardest;
  }
  const Timed* taken = harder != nullptr ? harder : hardest;
  return taken == nullptr ? std::nullopt
                          : std::optional(CodeTime{taken->seconds, std::string(taken->code)});
}

}  // namespace

std::optional<CodeTime> FindHandlingTime(std::string_view code) {
  return FindTime(kHandling, kHandlingRanks, HandlingClassOf, code);
}

std::optional<CodeTime> FindInsertionTime(std::string_view code) {
  return FindTime(kInsertion, kInsertionRanks, InsertionClassOf, code);
}

std::string DescribeHandling(std::string_view code) {
  if (!IsCode(code)) {
    return {};
  }
  constexpr std::array<std::string_view, 4> kSymmetries{
      "alpha + beta below 360 deg", "alpha + beta from 360 to below 540 deg",
      "alpha + beta from 540 to below 720 deg", "alpha + beta 720 deg"};
  constexpr std::array<std::string_view, 5> kSizes{
      "thicker than 2 mm, larger than 15 mm", "thicker than 2 mm, 6 to 15 mm large",
      "thicker than 2 mm, smaller than 6 mm", "2 mm thick or thinner, larger than 6 mm",
      "2 mm thick or thinner, 6 mm large or smaller"};
  const auto first = static_cast<std::size_t>(code[0] - '0');
  const auto second = static_cast<std::size_t>(code[1] - '0');
  if (first < kSymmetries.size()) {
    return fmt::format("one hand, {}, {}{}", kSymmetries[first],
                       second < 5 ? "" : "nests, tangles or bends, ", kSizes[second % 5]);
  }
  return first == 8 ? "two hands, for its size or weight" : "one hand, with an aid to grasp it";
}

std::string DescribeInsertion(std::string_view code) {
  if (!IsCode(code)) {
    return {};
  }
  constexpr std::array<std::string_view, 3> kAccess{"easy access", "obstructed access or view",
                                                    "obstructed access and view"};
  const auto first = static_cast<std::size_t>(code[0] - '0');
  const auto second = static_cast<std::size_t>(code[1] - '0');
  if (first < 3) {
    constexpr std::array<std::string_view, 4> kEase{
        "easy to align", "easy to align, against resistance", "not easy to align",
        "not easy to align, against resistance"};
    return fmt::format("added, not secured; {}; {}{}", kAccess[first],
                       second >= 6 ? "has to be held down; " : "",
                       kEase[second >= 6 ? second - 6 : std::min<std::size_t>(second, 3)]);
  }
  if (first < 6) {
    constexpr std::size_t kScrew = 8;  // The chart has screws in its columns 8 and 9.
    const std::string_view how = second < kScrew ? "pressed or snapped in"
                                 : second == kScrew
                                     ? "screwed in, easy to align"
                                     : "screwed in, not easy to align or against resistance";
    return fmt::format("secured at once; {}; {}", kAccess[first - 3], how);
  }
  return "a separate operation";
}

Result<DfaSheet> MakeDfaSheet(std::vector<DfaRow> rows) {
  DfaSheet sheet;
  for (const DfaRow& row : rows) {
    const auto handling = FindHandlingTime(row.handling);
    const auto insertion = FindInsertionTime(row.insertion);
    if (!handling || !insertion) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("there is no time for the {} code \"{}\"",
                      handling ? "insertion" : "handling", handling ? row.insertion : row.handling),
          row.part, "give a code of two digits, as 30 to handle and 06 to insert");
    }
    if (row.count < 1 || row.min_parts < 0 || row.min_parts > row.count) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("{} parts of which {} are needed cannot be", row.count, row.min_parts),
          row.part, "give a count of one or more, and as many needed parts at most");
    }
    sheet.times.push_back(
        {*handling, *insertion, row.count * (handling->seconds + insertion->seconds)});
    sheet.parts += row.count;
    sheet.min_parts += row.min_parts;
    sheet.seconds += sheet.times.back().seconds;
  }
  sheet.rows = std::move(rows);
  return sheet;
}

}  // namespace hvas::shopfloor
