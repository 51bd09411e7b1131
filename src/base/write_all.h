#pragma once

#include <cstddef>
#include <span>

namespace hvas {

/** Writes all bytes to an open file, pipe or socket, also when signals interrupt it.
 @returns 0, or the errno of what went wrong. */
[[nodiscard]] int WriteAll(int descriptor, std::span<const std::byte> bytes);

}  // namespace hvas
