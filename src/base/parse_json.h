#pragma once

#include <cstddef>
#include <string_view>

namespace hvas {

/** Deepest nesting of arrays and objects in JSON that is read. Copying and printing a document
 calls itself for each level, and the smallest stack of a thread has room for some thousand; an
 assembly has less than a hundred levels. A choice. */
inline constexpr std::size_t kDeepestJson = 256;

/** Whether arrays and objects of a JSON text are nested deeper than kDeepestJson. */
[[nodiscard]] bool IsNestedTooDeep(std::string_view json_text) noexcept;

/** Parses a text of strangers: a file, a message, a field of a record. @tparam Json  A type of
 nlohmann's. @returns a discarded value where it is no JSON, or nested too deep. */
template <typename Json>
[[nodiscard]] Json ParseJson(std::string_view text) {
  return IsNestedTooDeep(text) ? Json(Json::value_t::discarded)
                               : Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

}  // namespace hvas
