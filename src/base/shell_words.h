#pragma once

#include <string>

namespace hvas {

/** Writes a word of a command line, in quotes where a POSIX shell needs them. */
[[nodiscard]] std::string QuoteWord(const std::string& word);

}  // namespace hvas
