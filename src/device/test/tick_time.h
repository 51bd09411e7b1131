#pragma once

#include <cstdint>

namespace hvas::device::testing {

inline constexpr std::int64_t kTickNs = 1'000'000;  ///< The period of the haptic loop [ns].

}  // namespace hvas::device::testing
