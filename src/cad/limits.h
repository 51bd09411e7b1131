#pragma once

#include <cstddef>

namespace hvas::cad {

/** The most parts that a file may place; what comes after them is left out, and a diagnostic says
 so. */
inline constexpr std::size_t kMaxOccurrences = 1000000;

}  // namespace hvas::cad
