#include "studio/header_value.h"

#include <algorithm>

#include <fmt/format.h>

namespace hvas::studio {
namespace {

bool IsControl(char c) {
  constexpr char kDelete = 0x7f;
  return static_cast<unsigned char>(c) < ' ' || c == kDelete;
}

/** Whether RFC 8187 lets the character stand for itself (attr-char), of which few are needed. */
bool IsPlain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
         c == '.' || c == '_';
}

}  // namespace

std::string MakeAttachmentValue(std::string_view name) {
  std::string ascii;
  std::string encoded;
  for (const char c : name) {
    // Backslashes and per cents are read differently by different browsers.
    const bool is_odd = IsControl(c) || static_cast<unsigned char>(c) > '~' || c == '"' ||
                        c == '\\' || c == '%' || c == '/';
    ascii += is_odd ? '_' : c;
    encoded += IsPlain(c)
                   ? std::string(1, c)
                   : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  const std::string value = fmt::format("attachment; filename=\"{}\"", ascii);
  return ascii == name ? value : fmt::format("{}; filename*=UTF-8''{}", value, encoded);
}

bool IsHeaderValue(std::string_view text) {
  return std::none_of(text.begin(), text.end(), IsControl);
}

}  // namespace hvas::studio
