#pragma once

#include <cstddef>
#include <string_view>

namespace hvas {

/** Length of the UTF-8 sequence that starts at `i` [bytes]; 0 where there is none (RFC 3629).
 @pre i < bytes.size(). */
[[nodiscard]] std::size_t MeasureUtf8(std::string_view bytes, std::size_t i = 0) noexcept;

}  // namespace hvas
