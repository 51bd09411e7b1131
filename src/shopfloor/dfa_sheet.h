#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

/** Design for assembly by Boothroyd and Dewhurst (Product Design for Assembly, 1989): a worksheet
 of a product's parts with the codes of their handling and insertion, its time and its index. The
 times are those of codes that stand in public worksheets and in Whitney (Mechanical Assemblies,
 2004, Fig. 15-1); the charts are their owners' and are not here. */
namespace hvas::shopfloor {

/** Ideal time of a part, by which the index is reckoned [s]: 2.93 (1.13 to handle and 1.8 to insert
 a part without difficulties); public worksheets have 3. */
inline constexpr double kIdealSeconds = 2.93;
inline constexpr double kIdealSecondsRounded = 3.0;

/** Time of a code. */
struct CodeTime {
  double seconds{0};  ///< [s]
  /** The code whose time this is: another one where none is public for that asked for. */
  std::string code;
};

/** Finds the time of a code of two digits. For a code without a public time it is the least of
 those that are more difficult in both digits, or where there is none the longest of its part of the
 chart. None where that has no times, or the text is no code. */
[[nodiscard]] std::optional<CodeTime> FindHandlingTime(std::string_view code);
[[nodiscard]] std::optional<CodeTime> FindInsertionTime(std::string_view code);

/** What a code says, in words of our own; empty for one without a public time. */
[[nodiscard]] std::string DescribeHandling(std::string_view code);
[[nodiscard]] std::string DescribeInsertion(std::string_view code);

/** A row of a worksheet: equal parts that come in the same way. */
struct DfaRow {
  std::string part;
  int count{1};
  std::string handling;   ///< Code of two digits.
  std::string insertion;  ///< Code of two digits.
  /** How many of them are needed at least: each that moves against what is there, or has to be of
   another material, or has to be apart so that others can be put together. */
  int min_parts{0};
};

/** Times of a row. */
struct DfaTimes {
  CodeTime handling;
  CodeTime insertion;
  double seconds{0};  ///< Count times both [s].
};

/** A worksheet with its sums. */
struct DfaSheet {
  std::vector<DfaRow> rows;
  std::vector<DfaTimes> times;  ///< Times of the rows.
  int parts{0};
  int min_parts{0};
  double seconds{0};  ///< [s]

  /** The index: the ideal time of the least number of parts over the time.
   @param ideal_seconds  Of one part [s]. */
  [[nodiscard]] double CalcIndex(double ideal_seconds) const {
    return seconds > 0 ? min_parts * ideal_seconds / seconds : 0;
  }
};

/** Makes a worksheet. Errors: kInvalid, with the part, for a code that has no time, a count below
 one, or more needed parts than there are. */
[[nodiscard]] Result<DfaSheet> MakeDfaSheet(std::vector<DfaRow> rows);

}  // namespace hvas::shopfloor
