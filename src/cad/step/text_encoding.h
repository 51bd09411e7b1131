#pragma once

#include <string>
#include <string_view>

namespace hvas::cad {

/** Whether bytes are UTF-8 (RFC 3629). */
[[nodiscard]] bool IsUtf8(std::string_view bytes);

/** A name from a CAD file in valid UTF-8, without control characters and surrounding blanks.
 Lone surrogates become U+FFFD. Where no unit is beyond 0xFF and one is beyond 0x7F the text may be
 raw bytes that nobody decoded; then as the other overload, if they make sense as UTF-8, Latin text
 of DOS or Shift-JIS. */
[[nodiscard]] std::string CleanName(std::u16string_view name);

/** The encoding that bytes are most likely of, as cad/encoding.h names it: UTF-8 where they are
 that, which is certain; else Latin text of DOS (CP850) where few letters among many are what only
 that code page has there; else Shift-JIS (CP932) where they are that and have lead bytes that Latin
 text does not use (0x81..0x9F); Chinese (GB18030) or Russian (CP1251) where letters beyond ASCII
 stand in a row as in no Latin text; else Windows-1252 (CP1252), which has Latin-1 in it. The more
 text there is, the better it tells. */
[[nodiscard]] std::string GuessEncoding(std::string_view bytes);

/** UTF-8 from bytes of an unknown encoding, that of GuessEncoding(). */
[[nodiscard]] std::string CleanName(std::string_view name);

/** The bytes of a string of ISO 10303-21 with its escapes (section 6.4.3) as UTF-8: \X2\, \X4\,
 \X\hh, \S\c of ISO 8859-1 or of the part that \PA\ to \PI\ names, and doubled backslashes. What is
 no escape stays as it is. */
[[nodiscard]] std::string DecodeStepText(std::string_view text);

}  // namespace hvas::cad
