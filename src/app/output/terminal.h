#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

/** What a terminal can show. */
namespace hvas::app {

/** The columns that text on the standard output may take: the variable COLUMNS, or those of the
 terminal, or 80 where it is none; at least 40. */
[[nodiscard]] std::size_t CountColumns();

enum class Style { kHeading, kName, kGood, kBad };

/** The text in a style where the stream is a terminal that has colours and nobody has set NO_COLOR
 (no-color.org); elsewhere the text as it is. */
[[nodiscard]] std::string Painted(std::string_view text, Style style, std::FILE* stream = stdout);

}  // namespace hvas::app
