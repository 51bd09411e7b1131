#pragma once

#include <cstddef>
#include <cstdint>

namespace hvas::cad {

/** The most parts that a file may place, unless somebody allows more: as many as the studio shows.
 */
inline constexpr std::size_t kDefaultMaxParts = 16384;

/** The most that anybody can allow. */
inline constexpr std::size_t kLargestMaxParts = 1'000'000;

/** What the reading process gets of the memory that the work on a file may take; the rest is for
 what it hands over. */
[[nodiscard]] constexpr std::uint64_t ShareOfReader(std::uint64_t memory) {
  return memory / 4 * 3;
}

/** What the product that it hands over may take. */
[[nodiscard]] constexpr std::uint64_t ShareOfProduct(std::uint64_t memory) {
  return memory / 4;
}

}  // namespace hvas::cad
