#pragma once

#include <cctype>
#include <string>
#include <string_view>

/** Letters and digits of names, of which only those in ASCII have a meaning here. */
namespace hvas::product {

[[nodiscard]] inline bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

/** True for small letters. */
[[nodiscard]] inline bool IsLetter(char c) {
  return c >= 'a' && c <= 'z';
}

[[nodiscard]] inline std::string ToLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return lower;
}

}  // namespace hvas::product
