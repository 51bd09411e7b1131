#include "base/utf8.h"

#include <cstdint>

namespace hvas {
namespace {

std::uint8_t ReadByte(std::string_view bytes, std::size_t i) {
  return static_cast<std::uint8_t>(bytes[i]);
}

}  // namespace

std::size_t MeasureUtf8(std::string_view bytes, std::size_t i) noexcept {
  const std::uint8_t lead = ReadByte(bytes, i);
  if (lead < 0x80) {
    return 1;
  }
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || i + length > bytes.size()) {
    return 0;
  }
  for (std::size_t k = 1; k < length; ++k) {
    if ((ReadByte(bytes, i + k) & 0xC0U) != 0x80) {
      return 0;
    }
  }
  const std::uint8_t second = ReadByte(bytes, i + 1);
  const bool is_overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool is_beyond = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
  return is_overlong || is_beyond ? 0 : length;
}

}  // namespace hvas
