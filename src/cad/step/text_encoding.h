#pragma once

#include <string>
#include <string_view>

namespace hvas::cad {

/** Whether bytes are UTF-8 (RFC 3629). */
[[nodiscard]] bool IsUtf8(std::string_view bytes);

/** A name from a CAD file in valid UTF-8, without control characters and surrounding blanks.
 Lone surrogates become U+FFFD. Where no unit is beyond 0xFF and one is beyond 0x7F the text may be
 raw bytes that nobody decoded; then as the other overload, if they make sense as UTF-8 or
 Shift-JIS. */
[[nodiscard]] std::string CleanName(std::u16string_view name);

/** UTF-8 from bytes of an unknown encoding: UTF-8 where they are that; else Shift-JIS where they
 are that and have lead bytes that Latin text does not use (0x81..0x9F); else Windows-1252, which
 has Latin-1 in it. */
[[nodiscard]] std::string CleanName(std::string_view name);

/** The bytes of a string of ISO 10303-21 with its escapes (section 6.4.3) as UTF-8: \X2\, \X4\,
 \X\hh and \S\c of ISO 8859-1, and doubled backslashes. What is no escape stays as it is. */
[[nodiscard]] std::string DecodeStepText(std::string_view text);

}  // namespace hvas::cad
