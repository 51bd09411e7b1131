#pragma once

#include <cstddef>
#include <vector>

#include "base/result.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

/** Checks that an order that comes from outside can be followed: it begins with a base, each part
 is where a step takes it from, and directions, lengths and poses are sound. Parts may be missing.
 Errors: kInvalid, with the number of the step. */
[[nodiscard]] Result<void> CheckSteps(const std::vector<SequenceStep>& steps,
                                      std::size_t part_count);

}  // namespace hvas::sequence
