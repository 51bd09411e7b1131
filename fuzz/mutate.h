#pragma once

#include <string>
#include <string_view>

#include "base/random.h"

namespace hvas::fuzz {

/** A damaged copy of a file: one to eight of bits flipped, bytes written over, pieces cut out,
 doubled or moved, numbers replaced by awkward ones, the end cut off. Same random state, same copy.
 */
[[nodiscard]] std::string Mutate(std::string_view seed, Random* random);

}  // namespace hvas::fuzz
